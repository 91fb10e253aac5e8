// Cumulative curves: share of all runs (with those without a value) up to each value.

function drawCurves(rows, x, frame) {
  const { width, left, right, narrow } = frame;
  const top = narrow ? 16 + 20 * rows.length : 12;
  const height = top + 248;
  const y = scale([0, 1], [height - 8, top], 4);
  const series = report.series[state.series];
  const picture = canvas(width, height + 36, bottomAxis(x, top, height - 8, series.reference), axisTitle(x, height + 30, measureOf(series)));
  for (const tick of y.ticks) {
    picture.append(svg("line", { class: "grid", x1: left, x2: right, y1: round(y.place(tick)), y2: round(y.place(tick)) }),
      label(`${Math.round(100 * tick)} %`, left - 8, y.place(tick) + 4, "tick", "end"));
  }
  picture.append(label("share of runs", left + 4, top + 14, "tick"));
  rows.forEach((row, i) => {
    picture.append(curveOf(row, x, y));
    const line = narrow ? 10 + 20 * i : 24 + 56 * i;
    picture.append(marker(row.planner, 10, line, 5), label(shortened(row.planner), 22, line + 4),
      narrow ? label(countText(row.about), width - 4, line + 4, "tick", "end") : counts(row.about, width - RIGHT + 14, line));
  });
  return picture;
}

function curveOf({ planner, runs, about }, x, y) {
  const inside = (value) => Math.min(x.place(x.high), Math.max(x.place(x.low), x.place(value)));
  let path = `M${round(x.place(x.low))} ${round(y.place(0))}`;
  about.sorted.forEach((value, k) => { path += `H${round(inside(value))}V${round(y.place((k + 1) / runs.length))}`; });
  path += `H${round(x.place(x.high))}`;
  const group = svg("g", {}, svg("path", { class: `curve p${planner % SHAPES.length}`, d: path }));
  for (const q of [0.25, 0.5, 0.75]) {
    const k = Math.ceil(q * runs.length) - 1;
    if (k >= 0 && k < about.ok) group.append(marker(planner, inside(about.sorted[k]), y.place((k + 1) / runs.length), 4.5, "ringed"));
  }
  return group;
}
