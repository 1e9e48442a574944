// One of the pictures on the page: its scene, its options, and what was drawn last.

import { LivePicture, addressOf, sendForJson } from "./server.js";

/** Describes a scene that was not loaded yet. */
const kNoScene = { name: "", words: [], cameras: [], variants: [], animations: [], integrators: [], tonemaps: [], views: [],
  warnings: [], env_rotation: 0, env_intensity: 1, center: [0, 0, 0], distance: 1, width: 640, height: 480, scenes: 1 };

export class Side {
  scene = kNoScene; // the description of the scene file
  status = null;
  error = "";
  isDone = false;
  hasPicture = false;
  hasScene = false; // whether the scene file was ever loaded
  #revision; // of the scene file
  #channels; // those that were given when "variance" replaced them

  /** `number` is that of the scene file. The page has the functions described(side), shown(side) and accepted(side). */
  constructor(page, canvas, number, options) {
    Object.assign(this, { page, canvas, number, options });
    this.live = new LivePicture(number, (bitmap, status) => this.#show(bitmap, status), (text, status) => this.#fail(text, status),
      () => page.accepted(this));
  }

  /** The options that the integrator can't apply. Empty until the server has said which. */
  get omitted() {
    return this.status !== null && this.live.isCurrent(this.status) ? this.status.omitted : [];
  }

  /** Returns a side with the same options. */
  beside(canvas, number) {
    const side = new Side(this.page, canvas, number, this.options.copy());
    if (number === this.number) {
      [side.scene, side.hasScene, side.#revision] = [this.scene, this.hasScene, this.#revision];
    }
    return side;
  }

  /** Draws the picture with its present options. */
  request(isMoving = false) {
    this.isDone = false;
    this.live.request(this.options.words, isMoving);
  }

  /** Selects an integrator. "variance" stands for the path tracer's channel of that name, which replaces other channels. */
  integrate(name) {
    const { options } = this;
    const isVariance = name === "variance";
    const channels = options.get("--aov");
    options.set("--integrator", isVariance ? "path" : name);
    if (isVariance) {
      if (channels !== "variance") this.#channels = channels;
      options.set("--aov", "variance");
    } else if (channels === "variance") {
      options.set("--aov", this.#channels);
    }
  }

  close() {
    this.live.close();
    this.canvas.hidden = true;
  }

  /** Reads the description of the scene file. */
  async describe() {
    const revision = this.#revision;
    try {
      const scene = await sendForJson("POST", addressOf("scene", { scene: this.number }), this.options.words.join("\n"));
      if (revision !== this.#revision) return; // the file has changed again
      this.scene = scene;
      this.hasScene = true;
      this.#revision = scene.revision;
    } catch (error) {
      if (revision !== this.#revision) return;
      this.error = error.message;
      if (!this.hasScene) this.scene = { ...kNoScene, ...error.answer };
      this.#revision = error.answer?.revision ?? revision;
    }
    this.page.described(this);
  }

  /** Returns false if `number` is that of a camera or an animation that the list of the scene doesn't have. */
  has(list, number) {
    return !(Number(number) >= this.scene[list].length);
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
    this.hasPicture = true;
    this.#note(status, "");
  }

  #fail(text, status) {
    if (this.status !== null && status.request < this.status.request) return;
    this.#note({ ...this.status, omitted: [], warning: undefined, ...status, done: true }, text);
  }

  #note(status, error) {
    this.status = status;
    this.error = error;
    this.isDone = status.done;
    this.page.shown(this);
    this.#follow(status.revision);
  }

  /** Reads the description again if the file has changed. */
  #follow(revision) {
    if (revision === undefined || revision === this.#revision) return;
    this.#revision = revision;
    this.describe();
  }
}
