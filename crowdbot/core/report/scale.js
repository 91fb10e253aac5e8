// Scales: values to positions in a picture.

const sizeOf = (low, high) => Math.max(Math.abs(low), Math.abs(high)) || 1;

/** Returns true if numbers differ by more than rounding; otherwise there are no round ticks. */
const isWide = (low, high) => high - low > 1e-9 * sizeOf(low, high);

/** A linear scale with round ticks. */
function scale([low, high], [from, to], wanted = 5) {
  if (!isWide(low, high)) [low, high] = [low - 0.5 * sizeOf(low, high), high + 0.5 * sizeOf(low, high)];
  const place = (value) => from + ((value - low) / (high - low)) * (to - from);
  const raw = (high - low) / wanted;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 2.5, 5, 10].find((m) => m * power >= raw) * power;
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) ticks.push(k * step);
  const decimals = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9) + (step / power === 2.5 ? 1 : 0));
  return { place, ticks, low, high, label: (v) => format(v, decimals) };
}

/**
 * The span worth showing: everything, or without the farthest hundredth where single values are
 * so far out that the others would fall on one line.
 */
function spanOf(numbers, marks = []) {
  const sorted = Float64Array.from(numbers.filter(Number.isFinite)).sort();
  if (!sorted.length) return [0, 1];
  let [low, high] = [sorted[0], sorted[sorted.length - 1]];
  const [q1, q3] = [quantile(sorted, 0.25), quantile(sorted, 0.75)];
  const reach = 5 * (q3 - q1);
  if (reach > 0 && high > q3 + reach) high = Math.min(high, Math.max(quantile(sorted, 0.99), q3 + reach));
  if (reach > 0 && low < q1 - reach) low = Math.max(low, Math.min(quantile(sorted, 0.01), q1 - reach));
  return widened([low, high], marks);
}

/** Returns the full range. */
function wholeSpan(numbers, marks = []) {
  const known = numbers.filter(Number.isFinite);
  return known.length ? widened([Math.min(...known), Math.max(...known)], marks) : [0, 1];
}

/** Returns the range with a margin, including marks that are near. */
function widened([low, high], marks) {
  for (const mark of marks) {
    const near = mark >= low - 0.5 * (high - low) && mark <= high + 0.5 * (high - low);
    if (near) [low, high] = [Math.min(low, mark), Math.max(high, mark)];
  }
  const room = isWide(low, high) ? 0.03 * (high - low) : 0.03 * sizeOf(low, high);
  return [low - room, high + room];
}

/** The axis under a picture, with the line of the reference. */
function bottomAxis(x, top, bottom, reference) {
  const parts = x.ticks.map((tick) => [
    svg("line", { class: "grid", x1: round(x.place(tick)), x2: round(x.place(tick)), y1: top, y2: bottom }),
    svg("text", { class: "tick", x: round(x.place(tick)), y: bottom + 15, "text-anchor": "middle", text: x.label(tick) }),
  ]).flat();
  if (reference && reference.value >= x.low && reference.value <= x.high) {
    const place = round(x.place(reference.value));
    parts.push(svg("line", { class: "reference", x1: place, x2: place, y1: top, y2: bottom }));
  }
  return svg("g", { "aria-hidden": "true" }, parts);
}
