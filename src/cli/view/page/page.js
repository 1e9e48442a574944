// One picture of the scene, or two side by side, and what the user does with them.

import { FreeCamera } from "./camera.js";
import { Comparison } from "./compare.js";
import { showCommand, showControls, showWarnings } from "./controls.js";
import { copyTextOf, savePicture } from "./keep.js";
import { Options } from "./options.js";
import { Explanation } from "./pixel.js";
import { addressOf, sendForJson } from "./server.js";
import { Side } from "./side.js";

const byId = (id) => document.getElementById(id);
const stage = byId("stage");
const canvases = [byId("picture"), byId("other")];

export class Page {
  sides = [];
  comparison = new Comparison();
  #editing = 0;
  #shownScene = null;
  #camera = null; // a FreeCamera while the mouse or the keys determine the camera
  #hasStarted = false; // whether the scene was ever loaded
  #first = new Options([]); // those with which the page starts
  #message = ""; // an error of a command
  #asked = null;
  #explanation = new Explanation(byId("explanation"));
  #playing = 0;

  /** The side that is being edited. */
  get side() {
    return this.sides[this.#editing];
  }

  async start() {
    const side = new Side(this, canvases[0], 0, new Options([]));
    this.sides = [side];
    await side.describe();
    if (side.scene.scenes > 1) await this.#openSecond(1);
    this.request();
  }

  #showControls() {
    showControls(this.side, this.#editing, this.#shownScene !== this.side.scene);
    this.#shownScene = this.side.scene;
  }

  /** Called when the description of a side's scene was read, or could not be read. */
  described(side) {
    if (side === this.sides[0] && !this.#hasStarted) this.#adoptOptions(side);
    if (side === this.side) this.#showControls();
    this.#showState();
  }

  /** Takes the program's options. Once the scene is loaded, they have its exposure. */
  #adoptOptions({ scene, hasScene }) {
    const present = new Options(scene.words);
    for (const { options } of this.sides) options.follow(this.#first, present);
    this.#first = present;
    this.#hasStarted = hasScene;
  }

  /** Called when a side shows another picture, or an error. */
  shown(side) {
    this.#showState();
    if (side === this.side) {
      this.#showStatus();
      showCommand(side);
      showWarnings(side);
    }
    if (side.error === "") this.showComparison();
  }

  /** Called when the server knows what a side requests. */
  accepted(side) {
    if (side === this.side) showCommand(side);
  }

  /** Shows the errors of all sides, and whether something is being drawn. */
  #showState() {
    const names = this.sides.length > 1 ? ["Left picture: ", "Right picture: "] : [""];
    const errors = this.sides.map(({ error }, i) => error && `${names[i]}${error}`);
    const text = [...errors, this.#message].filter((error) => error !== "").join("\n\n");
    byId("error").textContent = text;
    byId("error").hidden = text === "";
    const state = errors.some((error) => error !== "") ? "error" : "done";
    document.body.dataset.state = this.sides.every(({ isDone }) => isDone) ? state : "drawing";
  }

  #showStatus() {
    const { status, error, hasPicture, canvas } = this.side;
    if (error !== "") {
      byId("status").textContent = hasPicture ? "The last picture is shown" : "No picture";
      return;
    }
    const { samples, of, seconds, camera, width, height, done, omitted } = status;
    const progress = done ? `${samples} ${samples === 1 ? "sample" : "samples"}, ${seconds.toFixed(2)} s` : `${status.preview ? 0 : samples} of ${of} samples`;
    const without = omitted.length > 0 ? `, without ${omitted.join(", ")}` : "";
    byId("status").textContent = `${width} x ${height}, ${progress}${without}`;
    byId("progress").value = done ? 1 : samples / of;
    canvas.classList.toggle("small", canvas.width < stage.clientWidth / 2);
    if (camera.fov !== undefined) {
      byId("fov").value = camera.fov;
      byId("fov-text").textContent = camera.fov.toFixed(1);
    }
    this.#limitPixel("x", status.x, width);
    this.#limitPixel("y", status.y, height);
    Object.assign(document.body.dataset, { request: status.request, samples, seconds });
  }

  #limitPixel(name, first, length) {
    const input = byId(name);
    [input.min, input.max] = [first, first + length - 1];
    if (Number(input.value) < first) input.value = first;
  }

  /** Draws the pictures with their present options. */
  request(isMoving = false) {
    this.#message = "";
    byId("marker").hidden = true;
    for (const side of this.sides) side.request(isMoving);
    document.body.dataset.state = "drawing";
    showCommand(this.side);
  }

  /** Sets an option of the side that is being edited. */
  set(name, value, isFinal = true) {
    if (name === "--integrator") this.side.integrate(value);
    else this.side.options.set(name, value);
    this.request(!isFinal);
  }

  setSize(width, height) {
    for (const { options } of this.sides) options.set("--size", width && height ? `${width}x${height}` : "");
    this.#showControls();
    this.request();
  }

  /** Selects an animation by its number, "all", or "" for none, in scenes that have it. */
  selectAnimation(value) {
    for (const { options } of this.#animated(value)) {
      options.set("--animation", value);
      options.set("--time", value === "" ? "" : "0");
    }
    if (value === "") this.#pause();
    this.#showControls();
    this.request();
  }

  setTime(time, isFinal = true) {
    for (const { options } of this.#animated("")) options.set("--time", String(Number(Number(time).toFixed(4))));
    this.#showControls();
    this.request(!isFinal);
  }

  /** Returns the sides whose scenes have an animation, with this number if there is one. */
  #animated(number) {
    return this.sides.filter((side) => side.scene.animations.length > 0 && side.has("animations", number));
  }

  /** Plays the animation, or stops it. Has no effect on scenes without one. */
  play() {
    if (this.#playing) {
      this.#pause();
      this.request();
    } else if (this.#animated("").length > 0) {
      const start = performance.now() - 1000 * Number(byId("time").value);
      this.#playing = setInterval(() => {
        const end = Number(byId("time").max) || 1; // that of the animation selected now
        this.setTime(((performance.now() - start) / 1000) % end, false);
      }, 1000 / 24);
      byId("play").textContent = "Pause";
    }
  }

  #pause() {
    clearInterval(this.#playing);
    this.#playing = 0;
    byId("play").textContent = "Play";
  }

  /** Selects the default camera, a camera of the scene, or a view. */
  selectCamera(words) {
    this.#camera = null;
    const [name, value] = words.split(" ");
    for (const side of this.sides) {
      // Two files may have different cameras.
      if (name === "--camera" && !side.has("cameras", value)) continue;
      for (const other of ["--camera", "--view", "--eye", "--target", "--up", "--fov"]) side.options.set(other, "");
      if (value !== undefined) side.options.set(name, value);
    }
    if (words === "free") this.move(() => {}, true);
    else this.request();
    this.#showControls();
  }

  /** Changes the free camera, which starts from the camera of the picture. */
  move(change, isFinal) {
    const { status, scene } = this.side;
    if (!status?.camera) return;
    this.#camera ??= FreeCamera.from(status.camera, scene);
    change(this.#camera);
    const words = new Options(this.#camera.words);
    for (const { options } of this.sides) {
      for (const name of ["--camera", "--view"]) options.set(name, "");
      for (const name of ["--eye", "--target", "--up", "--fov"]) options.set(name, words.get(name) ?? "");
    }
    this.#showControls();
    this.request(!isFinal);
  }

  /** Explains a pixel of the picture; of both pictures if two are compared. */
  async ask(x, y) {
    const asked = { x, y };
    this.#asked = asked;
    byId("x").value = x;
    byId("y").value = y;
    this.#showMarker();
    try {
      const answers = await Promise.all(this.sides.map(({ options, number }) =>
        sendForJson("POST", addressOf("explanation", { x: x + 0.5, y: y + 0.5, scene: number }), options.words.join("\n"))));
      if (this.#asked === asked) this.#explanation.show(answers);
    } catch (error) {
      if (this.#asked === asked) this.#explanation.fail(error.message);
    }
  }

  #showMarker() {
    const marker = byId("marker");
    const { canvas, status } = this.side;
    const box = canvas.getBoundingClientRect();
    const area = stage.getBoundingClientRect();
    marker.style.left = `${box.left - area.left + ((this.#asked.x - status.x + 0.5) / status.width) * box.width}px`;
    marker.style.top = `${box.top - area.top + ((this.#asked.y - status.y + 0.5) / status.height) * box.height}px`;
    marker.hidden = false;
  }

  /** Returns the pixel below the pointer, or null. Its coordinates are those in the whole picture. */
  pixelAt(event) {
    const { canvas, status } = this.side;
    if (status?.width === undefined) return null;
    const box = canvas.getBoundingClientRect();
    const x = Math.floor(((event.clientX - box.left) / box.width) * status.width);
    const y = Math.floor(((event.clientY - box.top) / box.height) * status.height);
    return x >= 0 && y >= 0 && x < status.width && y < status.height ? { x: status.x + x, y: status.y + y } : null;
  }

  /** Places the marker and the wiper again after the canvases have moved. */
  place() {
    if (!byId("marker").hidden && this.side.status !== null) this.#showMarker();
    if (this.sides.length > 1) this.comparison.place(...this.sides);
  }

  /** Shows a second picture beside the first, of the other scene file if there is one, or hides it. */
  async compare() {
    const isOpening = this.sides.length === 1;
    if (isOpening) {
      await this.#openSecond(this.sides[0].scene.scenes - 1);
      this.side.request();
    } else {
      this.sides.pop().close();
      this.comparison.hide();
      this.edit(0);
    }
    this.#showState();
  }

  /** Adds a side that shows the scene file with this number. */
  async #openSecond(number) {
    const side = this.sides[0].beside(canvases[1], number);
    if (number !== this.sides[0].number) await side.describe();
    this.sides.push(side);
    this.edit(1);
  }

  edit(index) {
    this.#editing = index;
    const isComparing = this.sides.length > 1;
    byId("wiper-row").hidden = !isComparing;
    byId("compare").textContent = isComparing ? "End comparison" : "Compare";
    this.#showControls();
    if (this.side.status !== null) this.#showStatus();
  }

  showComparison() {
    if (this.sides.length > 1) this.comparison.show(...this.sides);
  }

  async save() {
    const button = byId("save");
    button.disabled = true;
    try {
      await savePicture(this.side, byId("format").value);
    } catch (error) {
      this.#message = error.message;
      this.#showState();
    } finally {
      button.disabled = false;
    }
  }

  copy() {
    return copyTextOf(byId("command"));
  }
}
