// Connects the controls, the mouse and the keys with the page.

import { onChange } from "./options.js";
import { Page } from "./page.js";
import { send } from "./server.js";

const byId = (id) => document.getElementById(id);
const stage = byId("stage");
const page = new Page();

function handlePointer() {
  const kClick = 3; // pixels of movement that still count as a click
  let start = null;
  stage.addEventListener("pointerdown", (event) => {
    start = { x: event.clientX, y: event.clientY, moved: false };
    stage.setPointerCapture(event.pointerId);
    stage.focus({ preventScroll: true });
  });
  stage.addEventListener("pointermove", (event) => {
    if (start === null) return;
    const dx = event.clientX - start.x;
    const dy = event.clientY - start.y;
    if (!start.moved && Math.hypot(dx, dy) < kClick) return;
    const height = stage.clientHeight;
    const isShift = event.shiftKey || (event.buttons & 6) !== 0;
    page.move((camera) => {
      if (isShift) camera.shift(-dx / height, dy / height);
      else camera.turn((-dx / height) * Math.PI, (dy / height) * Math.PI);
    }, false);
    start = { x: event.clientX, y: event.clientY, moved: true };
  });
  const end = (event) => {
    if (start === null) return;
    const { moved } = start;
    start = null;
    if (moved) page.request();
    else if (event.type === "pointerup") {
      const pixel = page.pixelAt(event);
      if (pixel) page.ask(pixel.x, pixel.y);
    }
  };
  stage.addEventListener("pointerup", end);
  stage.addEventListener("pointercancel", end);
  stage.addEventListener("contextmenu", (event) => event.preventDefault());
  let rest = 0;
  stage.addEventListener("wheel", (event) => {
    event.preventDefault();
    page.move((camera) => camera.zoom(Math.exp(event.deltaY / 1000)), false);
    clearTimeout(rest);
    rest = setTimeout(() => page.request(), 150);
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
      page.move((camera) => (event.shiftKey ? camera.shift(0.05 * x, 0.05 * y) : camera.turn(step * x, step * y)), true);
    } else if (zooms[event.key]) {
      page.move((camera) => camera.zoom(zooms[event.key]), true);
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
  addEventListener("pagehide", () => page.sides.forEach((side) => side.live.close()));
  addEventListener("pageshow", (event) => event.persisted && location.reload());
}

handlePointer();
handleKeys();
handleControls();
await page.start();
