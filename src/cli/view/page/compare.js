// Compares two pictures of equal size, as the canvases hold them.

const kAmplification = 8;

/** Returns the difference as image data, the number of differing pixels, and the first of them in reading order. */
export function differenceOf(a, b) {
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
    first ??= { x: (i / 4) % width, y: Math.floor(i / 4 / width) };
  }
  return { image, count, greatest, first, total: width * height };
}

export function textOf(difference) {
  if (difference === null) return "The pictures have different sizes.";
  const { count, total, greatest, first } = difference;
  if (count === 0) return "The pictures are equal.";
  const percent = ((100 * count) / total).toFixed(2);
  return `${count} pixels differ (${percent} %), by up to ${greatest} of 255; the first is ${first.x},${first.y}.`;
}
