// The camera that the mouse and the keys move: a position, a target, an up direction and a field of view.

const add = (a, b) => a.map((x, i) => x + b[i]);
const subtract = (a, b) => a.map((x, i) => x - b[i]);
const scale = (a, s) => a.map((x) => x * s);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.hypot(...a);
const normalize = (a) => scale(a, 1 / (length(a) || 1));

/** Rotates `v` about the unit vector `axis` by an angle in radians (Rodrigues' formula). */
function rotate(v, axis, angle) {
  const c = Math.cos(angle);
  const s = Math.sin(angle);
  return add(add(scale(v, c), scale(cross(axis, v), s)), scale(axis, dot(axis, v) * (1 - c)));
}

/** Rounds a number to a decimal place of at most `resolution`; 17 digits identify a float64. */
function rounded(x, resolution) {
  const placesOf = (number) => Math.floor(Math.log10(Math.abs(number)));
  const digits = placesOf(x) - placesOf(resolution) + 1;
  return digits > 0 ? Number(x.toPrecision(Math.min(digits, 17))) : 0;
}

const text = (point, resolution) => point.map((x) => String(rounded(x, resolution))).join(",");
const kResolution = 1e-7; // as a fraction of the distance, or of the length of a direction

export class FreeCamera {
  constructor(eye, target, up, fov) {
    Object.assign(this, { eye, target, up, fov });
  }

  /** Continues from a picture's camera. It turns about the point of its axis that is nearest to the scene's center. */
  static from(camera, scene) {
    const along = dot(subtract(scene.center, camera.eye), camera.forward);
    const distance = along > 1e-3 * scene.distance ? along : scene.distance;
    const target = add(camera.eye, scale(camera.forward, distance));
    // The horizon stays level unless the camera is tilted, or looks nearly up or down.
    const isLevel = Math.abs(camera.right[1]) < 1e-6 && Math.abs(camera.forward[1]) < 0.999;
    return new FreeCamera(camera.eye, target, isLevel ? [0, 1, 0] : camera.up, camera.fov ?? 45);
  }

  get words() {
    // Far from the origin, coordinates need more digits to place the eye as accurately about its target.
    const resolution = kResolution * length(subtract(this.eye, this.target));
    const words = ["--eye", text(this.eye, resolution), "--target", text(this.target, resolution)];
    const up = text(this.up, kResolution);
    if (up !== "0,1,0") words.push("--up", up);
    return [...words, "--fov", text([this.fov], 1e-5)];
  }

  /** Turns the camera about the target by angles in radians. */
  turn(right, up) {
    const axis = normalize(this.up);
    let back = rotate(subtract(this.eye, this.target), axis, -right);
    const side = normalize(cross(axis, back));
    const elevation = Math.asin(Math.max(-1, Math.min(1, dot(normalize(back), axis))));
    const limit = (89.5 / 180) * Math.PI;
    const wanted = Math.max(-limit, Math.min(limit, elevation + up));
    back = rotate(back, side, elevation - wanted);
    this.eye = add(this.target, back);
  }

  /** Shifts the camera and its target by fractions of the picture's height. */
  shift(right, up) {
    const back = subtract(this.eye, this.target);
    const side = normalize(cross(this.up, back));
    const height = 2 * length(back) * Math.tan((this.fov / 360) * Math.PI);
    const step = add(scale(side, right * height), scale(normalize(cross(back, side)), up * height));
    this.eye = add(this.eye, step);
    this.target = add(this.target, step);
  }

  /** Multiplies the distance from the target. */
  zoom(factor) {
    this.eye = add(this.target, scale(subtract(this.eye, this.target), factor));
  }
}
