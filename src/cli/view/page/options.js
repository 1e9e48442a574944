// The options of one picture, as the words of a command line, and the controls that change them.

/** Options with their values; flags have the value null, and options that are given several times have arrays. */
export class Options {
  #values = new Map();
  #joined = new Set(); // options whose value is part of the word, as in --ground=0.5

  constructor(words) {
    for (let i = 0; i < words.length; ++i) {
      const [, name, value] = words[i].match(/^(--[\w-]+)=(.*)$/s) ?? [];
      const hasValue = i + 1 < words.length && !words[i + 1].startsWith("--");
      if (name !== undefined) this.#joined.add(name);
      const option = name ?? words[i];
      const given = value ?? (hasValue ? words[++i] : null);
      this.#values.set(option, this.#values.has(option) ? [this.#values.get(option), given].flat() : given);
    }
  }

  get(name) {
    return this.#values.get(name);
  }

  /** Sets an option; an empty value removes it. */
  set(name, value) {
    if (value === "" || value === undefined) this.#values.delete(name);
    else this.#values.set(name, value);
  }

  /** Changes the options that are as in `former` to those of `present`. */
  follow(former, present) {
    for (const name of new Set([...former.#values.keys(), ...present.#values.keys()])) {
      if (present.#joined.has(name)) this.#joined.add(name);
      if (this.get(name) === former.get(name)) this.set(name, present.get(name));
    }
  }

  get words() {
    return [...this.#values].flatMap(([name, values]) => [values].flat().flatMap((value) => {
      if (value === null) return [name];
      return this.#joined.has(name) ? [`${name}=${value}`] : [name, value];
    }));
  }

  copy() {
    return new Options(this.words);
  }

  /** Returns a copy without these options. "--aov NAMES" stands for only these of the option's comma-separated values. */
  without(omitted) {
    const others = this.copy();
    for (const words of omitted) {
      const [name, values] = words.split(" ");
      const given = values === undefined ? "" : (others.get(name) ?? "");
      const kept = given.split(",").filter((value) => !values?.split(",").includes(value));
      others.set(name, kept.join(","));
    }
    return others;
  }
}

/** Quotes a word for a shell if necessary. */
function quoted(word) {
  return /^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;
}

/** Returns the command line that draws a picture of the scene file. */
export function commandLine(scene, options) {
  const words = ["microtrace", scene, ...options.words];
  // The default format has no channels. The name is otherwise the default one.
  if (options.get("--aov") !== undefined) words.push("-o", `${scene.replace(/^.*\//, "").replace(/(?<=.)\.[^.]*$/, "")}.exr`);
  return words.map(quoted).join(" ");
}

/** Selects a value in a list, to which it is added if it is missing. */
export function select(list, value, text = value) {
  if (![...list.options].some((option) => option.value === value)) list.add(new Option(text, value));
  list.value = value;
}

/** Fills a selection with values, after one for the default. */
export function fill(select, values, defaultText = "default") {
  const option = (text, value) => Object.assign(document.createElement("option"), { textContent: text, value });
  select.replaceChildren(option(defaultText, ""), ...values.map(([value, text]) => option(text ?? value, value)));
}

const controls = () => document.querySelectorAll("[data-option]");

function showNumber(control) {
  const text = control.nextElementSibling;
  if (control.type === "range" && text !== null) text.textContent = control.value;
}

/** Moves a slider to a value, which its range is extended to contain. */
function slide(control, value) {
  control.min = Math.min(control.min, value);
  control.max = Math.max(control.max, value);
  control.value = value;
}

/**
 * Shows the options in the controls with the attribute data-option. Without the option, a control shows its attribute
 * data-default. Zero is a value of its own if data-explicit is set.
 */
export function showOptions(options) {
  for (const control of controls()) {
    const value = options.get(control.dataset.option) ?? control.dataset.default;
    if (control.type === "range") slide(control, Number(value ?? 0));
    else if (control.type === "checkbox") control.checked = value !== undefined && value !== "false";
    else control.value = value ?? "";
    showNumber(control);
  }
}

/** Calls change(name, value, isFinal) when the user changes a control; isFinal is false while a slider moves. */
export function onChange(change) {
  for (const control of controls()) {
    const report = (isFinal) => {
      showNumber(control);
      const isRange = control.type === "range", isBox = control.type === "checkbox";
      const isZero = isRange && Number(control.value) === 0 && control.dataset.explicit === undefined;
      const isDefault = isZero || (isBox ? !control.checked : !isRange && control.value === control.dataset.default);
      change(control.dataset.option, isDefault ? "" : isBox ? null : control.value.trim(), isFinal);
    };
    control.addEventListener("change", () => report(true));
    if (control.type === "range") control.addEventListener("input", () => report(false));
  }
}
