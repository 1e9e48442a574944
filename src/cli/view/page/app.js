// The page: one picture of the scene, or two side by side, and the controls of their options.

import { FreeCamera } from "./camera.js";
import { differenceOf, textOf } from "./compare.js";
import { Options, commandLine, fill, onChange, showOptions } from "./options.js";
import { Explanation } from "./pixel.js";
import { LivePicture, addressOf, send, sendForJson } from "./server.js";

const byId = (id) => document.getElementById(id);
const stage = byId("stage");
const canvases = [byId("picture"), byId("other")];

/** A picture on the page: its options, and what was drawn last. */
class Side {
  status = null;
  hasPicture = false;

  constructor(index, scene, options) {
    this.index = index;
    this.scene = scene;
    this.options = options;
    this.canvas = canvases[index];
    this.live = new LivePicture(scene, (bitmap, status) => this.#show(bitmap, status), (text, status) => this.#fail(text, status));
  }

  request(isMoving = false) {
    this.live.request(this.options.words, isMoving);
  }

  close() {
    this.live.close();
    this.canvas.hidden = true;
  }

  #show(bitmap, status) {
    const { canvas } = this;
    if (canvas.width !== status.width) canvas.width = status.width;
    if (canvas.height !== status.height) canvas.height = status.height;
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.imageSmoothingEnabled = status.preview;
    context.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
    canvas.hidden = false;
    this.status = status;
    this.hasPicture = true;
    if (this.index === page.editing) byId("error").hidden = true;
    page.shown(this);
  }

  #fail(text, status) {
    if (this.status === null || status.request >= this.status.request) {
      byId("error").textContent = text;
      byId("error").hidden = false;
      document.body.dataset.state = "error";
      byId("status").textContent = this.hasPicture ? "The last picture is shown" : "No picture";
    }
    page.noteRevision(status.revision);
  }
}

class Page {
  sides = [];
  editing = 0;
  scene = null;
  #camera = null; // a FreeCamera while the mouse or the keys determine the camera
  #revision = 0;
  #asked = null;
  #explanation = new Explanation(byId("explanation"));
  #playing = 0;

  get side() {
    return this.sides[this.editing];
  }

  async start() {
    await this.#load([]);
    const options = new Options(this.scene?.words ?? []);
    this.sides = [new Side(0, 0, options)];
    this.#showControls();
    if (this.scene?.scenes > 1) this.compare(1);
    this.request();
  }

  /** Reads the description of the scene file. */
  async #load(words) {
    try {
      this.scene = await sendForJson("POST", addressOf("scene", { scene: this.side?.scene ?? 0 }), words.join("\n"));
    } catch (error) {
      byId("error").textContent = error.message;
      byId("error").hidden = false;
      this.scene ??= { name: "", words: [], cameras: [], variants: [], animations: [], integrators: [], tonemaps: [], views: [],
        warnings: [], center: [0, 0, 0], distance: 1, width: 640, height: 480, scenes: 1, ...error.scene };
      return;
    }
    this.#revision = this.scene.revision;
    this.#showScene();
  }

  #showScene() {
    const { scene } = this;
    document.title = `${scene.name} - microtrace`;
    byId("name").textContent = scene.name;
    byId("name").title = `${scene.objects} objects, ${scene.primitives} primitives, ${scene.lights} lights`;
    fill(byId("integrator"), [...scene.integrators, "variance"].map((name) => [name]));
    fill(byId("tonemap"), scene.tonemaps.map((name) => [name]));
    fill(byId("variant"), scene.variants.map((name, i) => [name || String(i)]), "as in the file");
    const cameras = scene.cameras.map((name, i) => [`--camera ${i}`, `camera ${name || i}`]);
    const views = scene.views.map((name) => [`--view ${name}`, name]);
    fill(byId("camera"), [...cameras, ...views, ["free", "free"]]);
    fill(byId("animation"), scene.animations.map(({ name }, i) => [String(i), name || String(i)]), "none");
    byId("variant-section").hidden = scene.variants.length === 0;
    byId("animation-section").hidden = scene.animations.length === 0;
    byId("warnings-section").hidden = scene.warnings.length === 0;
    byId("warnings").replaceChildren(...scene.warnings.map((warning) => {
      const item = document.createElement("li");
      const place = document.createElement("code");
      place.textContent = warning.pointer || `${warning.line}:${warning.column}`;
      item.append(place, ` ${warning.message}`);
      return item;
    }));
  }

  #showControls() {
    const { options } = this.side;
    showOptions(options);
    // The variance is a channel beside the colors, not a method of rendering.
    if (options.get("--aov") === "variance") byId("integrator").value = "variance";
    const size = (options.get("--size") ?? `${this.scene.width}x${this.scene.height}`).split("x");
    [byId("width").value, byId("height").value] = size;
    const named = ["--camera", "--view"].find((name) => options.get(name) !== undefined);
    const wanted = named ? `${named} ${options.get(named)}` : "";
    byId("camera").value = options.get("--eye") !== undefined ? "free" : wanted;
    byId("fov").disabled = options.get("--eye") === undefined && options.get("--view") === undefined;
    byId("animation").value = options.get("--animation") ?? (options.get("--time") !== undefined ? "0" : "");
    const animation = this.scene.animations[Number(byId("animation").value)] ?? this.scene.animations[0];
    byId("time").max = animation?.end ?? 1;
    byId("time").value = options.get("--time") ?? 0;
    byId("time-text").textContent = `${Number(byId("time").value).toFixed(2)} s`;
    byId("command").textContent = commandLine(this.scene.name, options.words);
    byId("side").value = String(this.editing);
  }

  /** Draws the pictures with their present options. */
  request(isMoving = false) {
    document.body.dataset.state = "drawing";
    byId("marker").hidden = true;
    for (const side of this.sides) side.request(isMoving);
    byId("command").textContent = commandLine(this.scene.name, this.side.options.words);
  }

  /** Sets an option of the side that is being edited. */
  set(name, value, isFinal = true) {
    this.side.options.set(name, value);
    if (name === "--integrator") {
      const isVariance = value === "variance";
      this.side.options.set("--integrator", isVariance ? "path" : value);
      this.side.options.set("--aov", isVariance ? "variance" : "");
    }
    this.request(!isFinal);
  }

  setTime(time, isFinal = true) {
    const animation = byId("animation").value;
    for (const { options } of this.sides) {
      options.set("--time", animation === "" ? "" : String(Number(Number(time).toFixed(4))));
      options.set("--animation", animation);
    }
    this.#showControls();
    this.request(!isFinal);
  }

  play() {
    const end = Number(byId("time").max);
    byId("play").textContent = this.#playing ? "Play" : "Pause";
    if (this.#playing) {
      clearInterval(this.#playing);
      this.#playing = 0;
      this.request();
      return;
    }
    if (byId("animation").value === "") byId("animation").value = "0";
    const start = performance.now() - 1000 * Number(byId("time").value);
    this.#playing = setInterval(() => {
      this.setTime(((performance.now() - start) / 1000) % (end || 1), false);
    }, 1000 / 24);
  }

  /** Selects the default camera, a camera of the scene, or a view. */
  selectCamera(words) {
    this.#camera = null;
    for (const { options } of this.sides) {
      for (const name of ["--camera", "--view", "--eye", "--target", "--up", "--fov"]) options.set(name, "");
      const [name, value] = words.split(" ");
      if (words !== "" && words !== "free") options.set(name, value);
    }
    if (words === "free") this.move(() => {}, true);
    else this.request();
    this.#showControls();
  }

  /** Changes the free camera, which starts from the camera of the picture. */
  move(change, isFinal) {
    const { status } = this.side;
    if (!status?.camera) return;
    this.#camera ??= FreeCamera.from(status.camera, this.scene);
    change(this.#camera);
    const words = new Options(this.#camera.words);
    for (const { options } of this.sides) {
      for (const name of ["--camera", "--view"]) options.set(name, "");
      for (const name of ["--eye", "--target", "--up", "--fov"]) options.set(name, words.get(name) ?? "");
    }
    this.#showControls();
    this.request(!isFinal);
  }

  shown(side) {
    this.noteRevision(side.status.revision);
    const isDone = this.sides.every(({ status }) => status?.done);
    document.body.dataset.state = isDone ? "done" : "drawing";
    if (side === this.side) this.#showStatus(side);
    this.#showComparison();
  }

  #showStatus(side) {
    const { status } = side;
    const { samples, of, seconds, camera } = status;
    const progress = status.done ? `${samples} ${samples === 1 ? "sample" : "samples"}, ${seconds.toFixed(2)} s` : `${status.preview ? 0 : samples} of ${of} samples`;
    byId("status").textContent = `${status.width} x ${status.height}, ${progress}`;
    byId("progress").value = status.done ? 1 : samples / of;
    side.canvas.classList.toggle("small", side.canvas.width < stage.clientWidth / 2);
    if (camera.fov !== undefined) {
      byId("fov").value = camera.fov;
      byId("fov-text").textContent = camera.fov.toFixed(1);
    }
    byId("x").max = status.width - 1;
    byId("y").max = status.height - 1;
    document.body.dataset.request = status.request;
    document.body.dataset.samples = samples;
    document.body.dataset.seconds = seconds;
  }

  /** Reads the description of the scene again if its file has changed. */
  async noteRevision(revision) {
    if (revision === undefined || revision === this.#revision) return;
    this.#revision = revision;
    await this.#load(this.side.options.words);
    this.#showControls();
    document.body.dataset.revision = revision;
  }

  /** Explains a pixel of the picture; of both pictures if two are compared. */
  async ask(x, y) {
    this.#asked = { x, y };
    byId("x").value = x;
    byId("y").value = y;
    this.#showMarker();
    try {
      const answers = await Promise.all(this.sides.map(({ options, scene }) =>
        sendForJson("POST", addressOf("explanation", { x: x + 0.5, y: y + 0.5, scene }), options.words.join("\n"))));
      this.#explanation.show(answers);
    } catch (error) {
      this.#explanation.fail(error.message);
    }
  }

  #showMarker() {
    const marker = byId("marker");
    const { canvas } = this.side;
    const box = canvas.getBoundingClientRect();
    const area = stage.getBoundingClientRect();
    marker.style.left = `${box.left - area.left + ((this.#asked.x + 0.5) / canvas.width) * box.width}px`;
    marker.style.top = `${box.top - area.top + ((this.#asked.y + 0.5) / canvas.height) * box.height}px`;
    marker.hidden = false;
  }

  /** Returns the pixel below the pointer, or null. */
  pixelAt(event) {
    const { canvas } = this.side;
    const box = canvas.getBoundingClientRect();
    const x = Math.floor(((event.clientX - box.left) / box.width) * canvas.width);
    const y = Math.floor(((event.clientY - box.top) / box.height) * canvas.height);
    return x >= 0 && y >= 0 && x < canvas.width && y < canvas.height ? { x, y } : null;
  }

  /** Shows a second picture, of the same scene or of another one, beside the first; or hides it. */
  compare(scene) {
    const isOpening = this.sides.length === 1;
    if (isOpening) {
      this.sides.push(new Side(1, scene, this.sides[0].options.copy()));
      this.editing = 1;
      this.sides[1].request();
    } else {
      this.sides.pop().close();
      this.editing = 0;
      canvases[0].style.clipPath = "";
      byId("wiper-line").hidden = true;
    }
    byId("wiper-row").hidden = !isOpening;
    byId("compare").textContent = isOpening ? "End comparison" : "Compare";
    this.#showControls();
    this.#showComparison();
  }

  edit(side) {
    this.editing = side;
    this.#showControls();
  }

  #showComparison() {
    if (this.sides.length < 2) return;
    const [left, right] = canvases;
    const part = Number(byId("wiper").value);
    left.style.clipPath = "";
    right.style.clipPath = `inset(0 0 0 ${part}%)`;
    const box = left.getBoundingClientRect();
    const area = stage.getBoundingClientRect();
    const line = byId("wiper-line");
    line.style.left = `${box.left - area.left + (part / 100) * box.width}px`;
    line.style.top = `${box.top - area.top}px`;
    line.style.height = `${box.height}px`;
    line.hidden = byId("difference").checked;
    if (!this.sides.every(({ hasPicture }) => hasPicture)) return;
    const difference = differenceOf(left, right);
    byId("difference-text").textContent = textOf(difference);
    byId("ask-first").disabled = !difference?.first;
    this.first = difference?.first;
    this.#showDifference(difference);
  }

  #showDifference(difference) {
    document.getElementById("difference-picture")?.remove();
    if (!byId("difference").checked || difference === null) return;
    const canvas = document.createElement("canvas");
    canvas.id = "difference-picture";
    canvas.width = difference.image.width;
    canvas.height = difference.image.height;
    canvas.getContext("2d").putImageData(difference.image, 0, 0);
    stage.insertBefore(canvas, byId("marker"));
  }

  showComparison() {
    this.#showComparison();
  }

  async save() {
    const button = byId("save");
    button.disabled = true;
    try {
      const address = addressOf("file", { format: byId("format").value, scene: this.side.scene });
      const response = await send("POST", address, this.side.options.words.join("\n"));
      const name = /filename="([^"]*)"/.exec(response.headers.get("Content-Disposition"))?.[1] ?? "picture";
      const link = document.createElement("a");
      link.href = URL.createObjectURL(await response.blob());
      link.download = name;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    } catch (error) {
      byId("error").textContent = error.message;
      byId("error").hidden = false;
    } finally {
      button.disabled = false;
    }
  }

  async copy() {
    const text = byId("command").textContent;
    try {
      await navigator.clipboard.writeText(text);
    } catch {
      // Browsers refuse in frames and for addresses that they don't trust. The text is then selected for the user.
      getSelection().selectAllChildren(byId("command"));
    }
  }
}

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
    byId(id).addEventListener("change", () => {
      const [width, height] = [byId("width").value, byId("height").value];
      for (const { options } of page.sides) options.set("--size", width && height ? `${width}x${height}` : "");
      page.request();
    });
  }
  byId("camera").addEventListener("change", (event) => page.selectCamera(event.target.value));
  byId("fov").addEventListener("input", (event) => page.move((camera) => { camera.fov = Number(event.target.value); }, false));
  byId("fov").addEventListener("change", () => page.request());
  byId("animation").addEventListener("change", () => page.setTime(0));
  byId("time").addEventListener("input", (event) => {
    if (byId("animation").value === "") byId("animation").value = "0";
    page.setTime(event.target.value, false);
  });
  byId("time").addEventListener("change", () => page.request());
  byId("ask").addEventListener("submit", (event) => {
    event.preventDefault();
    page.ask(Number(byId("x").value), Number(byId("y").value));
  });
  byId("wiper").addEventListener("input", () => page.showComparison());
  byId("difference").addEventListener("change", () => page.showComparison());
  byId("side").addEventListener("change", (event) => page.edit(Number(event.target.value)));
  onClick("ask-first", () => page.first && page.ask(page.first.x, page.first.y));
  onClick("play", () => page.play());
  onClick("save", () => page.save());
  onClick("copy", () => page.copy());
  onClick("compare", () => page.compare(page.sides[0].scene));
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
