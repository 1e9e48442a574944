// Compares two pictures of equal size, as the canvases hold them.

const byId = (id) => document.getElementById(id);
const kAmplification = 8;

/**
 * Returns the difference as image data, the number of differing pixels, and the first of them in reading order.
 * `origin` has the coordinates of the canvases' first pixel.
 */
function differenceOf(a, b, origin) {
  const width = a.width;
  const height = a.height;
  if (b.width !== width || b.height !== height) return null;
  const from = a.getContext("2d").getImageData(0, 0, width, height).data;
  const to = b.getContext("2d").getImageData(0, 0, width, height).data;
  const image = new ImageData(width, height);
  let count = 0;
  let greatest = 0;
  let first = null;
  for (let i = 0; i < from.length; i += 4) {
    let differs = false;
    for (let k = 0; k < 4; ++k) {
      const difference = Math.abs(from[i + k] - to[i + k]);
      greatest = Math.max(greatest, difference);
      if (difference !== 0) differs = true;
      image.data[i + k] = k === 3 ? 255 : kAmplification * difference;
    }
    if (!differs) continue;
    ++count;
    first ??= { x: origin.x + ((i / 4) % width), y: origin.y + Math.floor(i / 4 / width) };
  }
  return { image, count, greatest, first, total: width * height };
}

function textOf(difference) {
  if (difference === null) return "The pictures have different sizes.";
  const { count, total, greatest, first } = difference;
  if (count === 0) return "The pictures are equal.";
  const percent = ((100 * count) / total).toFixed(2);
  return `${count} pixels differ (${percent} %), by up to ${greatest} of 255; the first is ${first.x},${first.y}.`;
}

/** Two pictures with a wiper between them, or their difference. */
export class Comparison {
  first = null; // the first pixel that differs

  show(left, right) {
    this.place(left, right);
    if (!left.hasPicture || !right.hasPicture) return;
    const difference = differenceOf(left.canvas, right.canvas, left.status);
    byId("difference-text").textContent = textOf(difference);
    this.first = difference?.first ?? null;
    byId("ask-first").disabled = this.first === null;
    this.#showDifference(difference);
  }

  hide() {
    byId("wiper-line").hidden = true;
    byId("difference-picture")?.remove();
  }

  /** Divides the pictures at the wiper. */
  place({ canvas: left }, { canvas: right }) {
    const part = Number(byId("wiper").value);
    right.style.clipPath = `inset(0 0 0 ${part}%)`;
    const box = left.getBoundingClientRect();
    const area = byId("stage").getBoundingClientRect();
    const line = byId("wiper-line");
    line.style.left = `${box.left - area.left + (part / 100) * box.width}px`;
    line.style.top = `${box.top - area.top}px`;
    line.style.height = `${box.height}px`;
    line.hidden = byId("difference").checked;
  }

  #showDifference(difference) {
    byId("difference-picture")?.remove();
    if (!byId("difference").checked || difference === null) return;
    const canvas = document.createElement("canvas");
    canvas.id = "difference-picture";
    canvas.width = difference.image.width;
    canvas.height = difference.image.height;
    canvas.getContext("2d").putImageData(difference.image, 0, 0);
    byId("stage").insertBefore(canvas, byId("marker"));
  }
}
