// Connects the controls, the mouse and the keys with the page.

import { onChange } from "./options.js";
import { Page } from "./page.js";
import { send } from "./server.js";

const byId = (id) => document.getElementById(id);
const stage = byId("stage");
const page = new Page();

let rest = 0;

/** Moves the camera by the wheel or a key, whose last step is only known by the pause after it. */
function moveByStep(change) {
  page.move(change, false);
  clearTimeout(rest);
  rest = setTimeout(() => page.request(), 150);
}

/** Returns the center of two fingers, or of one, and the distance between them. */
function gripOf(fingers) {
  const [a, b = a] = fingers.values();
  return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, distance: Math.hypot(a.x - b.x, a.y - b.y) };
}

function handlePointer() {
  const kClick = 3; // pixels of movement that still count as a click
  const fingers = new Map(); // positions of the mouse, or of up to two fingers, by pointer
  let hasMoved = false;
  const placeOf = (event) => ({ x: event.clientX, y: event.clientY });
  stage.addEventListener("pointerdown", (event) => {
    if (fingers.size === 2) return;
    hasMoved = fingers.size > 0;
    fingers.set(event.pointerId, placeOf(event));
    stage.setPointerCapture(event.pointerId);
    stage.focus({ preventScroll: true });
  });
  stage.addEventListener("pointermove", (event) => {
    if (!fingers.has(event.pointerId)) return;
    const former = gripOf(fingers);
    const { clientX, clientY } = event;
    if (!hasMoved && Math.hypot(clientX - former.x, clientY - former.y) < kClick) return;
    hasMoved = true;
    fingers.set(event.pointerId, placeOf(event));
    const grip = gripOf(fingers);
    const height = stage.clientHeight;
    const [right, up] = [(former.x - grip.x) / height, (grip.y - former.y) / height];
    const isShift = event.shiftKey || (event.buttons & 6) !== 0 || fingers.size === 2;
    page.move((camera) => {
      if (isShift) camera.shift(right, up);
      else camera.turn(right * Math.PI, up * Math.PI);
      if (former.distance > 0 && grip.distance > 0) camera.zoom(former.distance / grip.distance);
    }, false);
  });
  const end = (event) => {
    if (!fingers.delete(event.pointerId) || fingers.size > 0) return;
    if (hasMoved) page.request();
    else if (event.type === "pointerup") {
      const pixel = page.pixelAt(event);
      if (pixel) page.ask(pixel.x, pixel.y);
    }
  };
  stage.addEventListener("pointerup", end);
  stage.addEventListener("pointercancel", end);
  stage.addEventListener("contextmenu", (event) => event.preventDefault());
  stage.addEventListener("wheel", (event) => {
    event.preventDefault();
    moveByStep((camera) => camera.zoom(Math.exp(event.deltaY / 1000)));
  }, { passive: false });
}

function handleKeys() {
  const step = (5 / 180) * Math.PI;
  const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  const zooms = { "+": 0.9, "=": 0.9, "-": 1 / 0.9 };
  const actions = {
    f: () => page.selectCamera(""), p: () => page.play(), c: () => page.copy(), s: () => page.save(),
  };
  stage.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (turns[event.key]) {
      const [x, y] = turns[event.key];
      moveByStep((camera) => (event.shiftKey ? camera.shift(0.05 * x, 0.05 * y) : camera.turn(step * x, step * y)));
    } else if (zooms[event.key]) {
      moveByStep((camera) => camera.zoom(zooms[event.key]));
    } else if (actions[event.key.toLowerCase()]) {
      actions[event.key.toLowerCase()]();
    } else {
      return;
    }
    event.preventDefault();
  });
}

function handleControls() {
  const onClick = (id, action) => byId(id).addEventListener("click", action);
  onChange((name, value, isFinal) => page.set(name, value, isFinal));
  for (const id of ["width", "height"]) {
    byId(id).addEventListener("change", () => page.setSize(byId("width").value, byId("height").value));
  }
  byId("camera").addEventListener("change", (event) => page.selectCamera(event.target.value));
  byId("fov").addEventListener("input", (event) => page.move((camera) => { camera.fov = Number(event.target.value); }, false));
  byId("fov").addEventListener("change", () => page.request());
  byId("animation").addEventListener("change", (event) => page.selectAnimation(event.target.value));
  byId("time").addEventListener("input", (event) => page.setTime(event.target.value, false));
  byId("time").addEventListener("change", () => page.request());
  byId("ask").addEventListener("submit", (event) => {
    event.preventDefault();
    page.ask(Number(byId("x").value), Number(byId("y").value));
  });
  byId("wiper").addEventListener("input", () => page.showComparison());
  byId("difference").addEventListener("change", () => page.showComparison());
  byId("side").addEventListener("change", (event) => page.edit(Number(event.target.value)));
  onClick("ask-first", () => {
    const { first } = page.comparison;
    if (first) page.ask(first.x, first.y);
  });
  onClick("play", () => page.play());
  onClick("save", () => page.save());
  onClick("copy", () => page.copy());
  onClick("compare", () => page.compare());
  onClick("end", async () => {
    await send("POST", "end").catch(() => {});
    byId("status").textContent = "The program has ended";
    for (const side of page.sides) side.live.close();
  });
  const observer = new ResizeObserver(() => page.place());
  for (const id of ["stage", "picture", "other"]) observer.observe(byId(id));
  addEventListener("pagehide", () => page.sides.forEach((side) => side.live.close()));
  addEventListener("pageshow", (event) => event.persisted && location.reload());
}

handlePointer();
handleKeys();
handleControls();
await page.start();
