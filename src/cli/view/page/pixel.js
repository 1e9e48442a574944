// Shows what the ray of a pixel meets, and why each hit counts or not.

function element(name, text, ...children) {
  const result = document.createElement(name);
  if (text !== null) result.textContent = text;
  result.append(...children);
  return result;
}

/** Nine digits identify a float32. Infinite numbers are strings in JSON. */
function shown(x) {
  return typeof x === "number" ? String(Number(x.toPrecision(9))) : x;
}

const list = (numbers) => numbers.map(shown).join(", ");

/** Returns a table of names and values; rows without a value are left out. */
function table(rows) {
  const kept = rows.filter(([, value]) => value !== undefined && value !== null && value !== "");
  return element("table", null, ...kept.map(([name, value]) => element("tr", null, element("th", name), element("td", value))));
}

const kVerdicts = {
  visible: "yes: the first surface that is visible",
  seen_through: "yes: seen through the surfaces before it",
  hidden: "no: behind opaque surfaces",
  culled: "no: the back of a one-sided surface",
  masked: "no: removed by the alpha mask",
  transparent: "no: alpha is 0",
  repeated: "once, with the neighboring triangle that has the same point",
};

const kOrders = {
  first: null,
  bounds: "t is larger than that of the previous hit, by float64 bounds",
  exact: "t is larger than that of the previous hit, by exact comparison",
  tie: "t equals that of the previous hit; the lower number comes first",
};

function planeRows({ slope, height, t }) {
  return [["n . d", shown(slope)], ["n . (p - o)", shown(height)], ["t of the plane", t === null ? "none" : shown(t)]];
}

function quadraticRows({ a, b, c, discriminant, signs, roots }) {
  const sign = { "-1": " (negative)", 0: " (exactly 0)", 1: "" }[signs.discriminant];
  return [
    ["a t^2 + b t + c", `a = ${shown(a)}, b = ${shown(b)}, c = ${shown(c)}`],
    ["b^2 - 4 a c", `${shown(discriminant)}${sign}`],
    [roots.length === 1 ? "root" : "roots", roots.length === 0 ? "none" : list(roots)],
  ];
}

/** The numbers of an intersection, by which one can follow its formula. */
function numberRows(numbers) {
  switch (numbers?.kind) {
    case "quadratic": return quadraticRows(numbers);
    case "plane": return planeRows(numbers);
    case "disc": return [...planeRows(numbers.plane), ["squared distance", shown(numbers.squared_distance)],
      ["squared radius", shown(numbers.squared_radius)], ...(numbers.ball ? quadraticRows(numbers.ball) : [])];
    case "triangle": return [...planeRows(numbers.plane), ["volumes", list(numbers.volumes)], ["the line passes", numbers.place],
      ["t in the triangle", numbers.stretch && list(numbers.stretch)]];
    default: return [["numbers", "none: the shape is empty"]];
  }
}

function primitiveRows(primitive) {
  return [...numberRows(primitive.numbers), ["decided by", primitive.decided_by], ["formulas", primitive.derivation]];
}

function nameOf({ name, object, primitive, type }) {
  const part = type === "mesh" ? `, triangle ${primitive}` : `, ${type}`;
  return `${name || `object ${object}`}${part}`;
}

function alphaText({ mode, value, cutoff, coverage, weight }) {
  const rest = mode === "mask" ? `, cutoff ${shown(cutoff)}` : "";
  return mode === "opaque" ? "opaque" : `${shown(value)} (${mode}${rest}), covers ${shown(coverage)}, weight ${shown(weight)}`;
}

function hitDetails(hit, index) {
  const summary = element("summary", `${index + 1}. t = ${shown(hit.t)} `, element("b", nameOf(hit)));
  const details = element("details", null, summary, table([
    ["counts", kVerdicts[hit.verdict]],
    ["order", kOrders[hit.order]],
    ["material", hit.material === null ? "default" : `${hit.material.index} ${hit.material.name}`],
    ["alpha", alphaText(hit.alpha)],
    ["depth", shown(hit.depth)],
    ["distance", shown(hit.distance)],
    ["position", list(hit.position)],
    ["normal", list(hit.normal)],
    ["shading normal", list(hit.shading_normal)],
    ["side", hit.front ? "front" : "back"],
    ["uv", hit.uv && list(hit.uv)],
    ["barycentric", hit.barycentrics && list(hit.barycentrics)],
    ["exact t", `${shown(hit.exact_t)}, rounded by ${hit.rounded_by}`],
    ...primitiveRows(hit),
  ]));
  details.open = hit.verdict === "visible";
  details.dataset.t = hit.t;
  details.dataset.verdict = hit.verdict;
  return details;
}

/** Returns a list of folded entries below a heading. */
function folded(heading, primitives, rowsOf) {
  if (!primitives?.length) return [];
  return [element("h3", heading), ...primitives.map((primitive) =>
    element("details", null, element("summary", nameOf(primitive)), table([...rowsOf(primitive), ...primitiveRows(primitive)])))];
}

function answerElements(answer) {
  const { hits, visible, stages, ray, pixel } = answer;
  const result = visible === null ? (hits.length === 0 ? "Nothing is hit." : "No hit is visible.") : `Hit ${visible + 1} is visible.`;
  const rest = answer.hit_count - hits.length;
  return [
    element("p", `${result} ${stages.edges + stages.filters} tests in float64, ${stages.grid + stages.dyadic} exact.`),
    table([["pixel", `${pixel.x - 0.5}, ${pixel.y - 0.5}`], ["origin", list(ray.origin)], ["direction", list(ray.direction)],
      ["interval", `${shown(ray.t_min)} to ${shown(ray.t_max)}`]]),
    ...hits.map(hitDetails),
    ...(rest > 0 ? [element("p", `${rest} more hits are not listed.`)] : []),
    ...folded("Outside of the interval", answer.crossings, ({ place, t }) => [["t", `${shown(t)}, ${place} the interval`]]),
    ...folded("Not hit", answer.misses, ({ reason }) => [["because", reason]]),
  ];
}

export class Explanation {
  constructor(element) {
    this.element = element;
  }

  fail(message) {
    this.element.textContent = message;
  }

  /** Shows one explanation, or those of the left and the right picture. */
  show(answers) {
    const parts = answers.flatMap((answer, i) => [
      ...(answers.length > 1 ? [element("h3", i === 0 ? "Left picture" : "Right picture")] : []),
      ...answerElements(answer),
    ]);
    this.element.replaceChildren(...parts);
    this.element.dataset.visible = answers[0].visible ?? "none";
  }
}
