// Shows a scene and the options of a picture in the controls.

import { commandLine, fill, select, showOptions } from "./options.js";

const byId = (id) => document.getElementById(id);

function warningItem({ pointer, line, column, message }) {
  const item = document.createElement("li");
  const place = document.createElement("code");
  place.textContent = pointer || (line ? `${line}:${column}` : "");
  item.append(...(place.textContent === "" ? [message] : [place, ` ${message}`]));
  return item;
}

function showScene(scene) {
  document.title = `${scene.name} - microtrace`;
  byId("name").textContent = scene.name;
  byId("name").title = `${scene.objects} objects, ${scene.primitives} primitives, ${scene.lights} lights`;
  fill(byId("integrator"), [...scene.integrators, "variance"].map((name) => [name]));
  fill(byId("tonemap"), scene.tonemaps.map((name) => [name]));
  fill(byId("variant"), scene.variants.map((name, i) => [String(i), name || String(i)]), "as in the file");
  const cameras = scene.cameras.map((name, i) => [`--camera ${i}`, `camera ${name || i}`]);
  const views = scene.views.map((name) => [`--view ${name}`, name]);
  fill(byId("camera"), [...cameras, ...views, ["free", "free"]]);
  const animations = scene.animations.map(({ name }, i) => [String(i), name || String(i)]);
  byId("env-rotation").dataset.default = scene.env_rotation;
  byId("env-intensity").placeholder = scene.env_intensity;
  fill(byId("animation"), animations.length > 1 ? [...animations, ["all", "all"]] : animations, "none");
  byId("variant-section").hidden = scene.variants.length === 0;
  byId("animation-section").hidden = scene.animations.length === 0;
}

/** Shows the warnings about the scene and about the options of its picture. */
export function showWarnings({ scene, status }) {
  const items = scene.warnings.map(warningItem);
  if (status?.warning) items.push(warningItem({ message: status.warning }));
  byId("warnings-section").hidden = items.length === 0;
  byId("warnings").replaceChildren(...items);
}

/** Returns the number of the list's entry that `text` names, or else the text, which may be a number. */
function numberOf(names, text) {
  const index = names.indexOf(text);
  return index < 0 || text === "" ? text : String(index);
}

function showCamera(scene, options) {
  const camera = options.get("--camera");
  const view = options.get("--view");
  let wanted = "";
  if (options.get("--eye") !== undefined) wanted = "free";
  else if (view !== undefined) wanted = `--view ${view}`;
  else if (camera !== undefined) wanted = `--camera ${numberOf(scene.cameras, camera)}`;
  select(byId("camera"), wanted, view);
  byId("fov").disabled = options.get("--eye") === undefined && options.get("--view") === undefined;
}

function showTime({ animations }, options) {
  const time = options.get("--time");
  // Without --animation, the time is that of the first animation.
  const wanted = options.get("--animation") ?? (time === undefined ? "" : "0");
  const animation = numberOf(animations.map(({ name }) => name), wanted);
  byId("animation").value = animation;
  const first = Number(animation) || 0;
  const shown = animation === "all" ? animations : animations.slice(first, first + 1);
  byId("time").max = shown.length === 0 ? 1 : Math.max(...shown.map(({ end }) => end));
  byId("time").value = time ?? 0;
  byId("time-text").textContent = `${Number(byId("time").value).toFixed(2)} s`;
}

function showVariant({ variants }, options) {
  byId("variant").value = numberOf(variants, options.get("--variant") ?? "");
}

/** Shows the command line that draws the picture, without the options that its integrator can't apply. */
export function showCommand({ scene, options, omitted }) {
  byId("command").textContent = commandLine(scene.name, options.without(omitted));
}

/** Shows the options of the side with this index, and first of all its scene if the controls show another one. */
export function showControls(side, index, isOther) {
  const { scene, options } = side;
  if (isOther) showScene(scene);
  showWarnings(side);
  showOptions(options);
  // The variance is a channel beside the colors, not a method of rendering.
  if (options.get("--aov") === "variance") byId("integrator").value = "variance";
  const size = (options.get("--size") ?? `${scene.width}x${scene.height}`).split("x");
  [byId("width").value, byId("height").value] = size;
  showCamera(scene, options);
  showTime(scene, options);
  showVariant(scene, options);
  showCommand(side);
  byId("side").value = String(index);
}
