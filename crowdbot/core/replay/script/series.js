// The series of a run that can be plotted against time: {key, name, unit, t, values}.

function seriesOf(run) {
  const found = run.robots.flatMap((robot, i) => robotSeries(run, robot, i));
  if (run.people) found.push(...peopleSeries(run));
  for (const { name, t, values } of run.signals) {
    found.push({ key: `signal/${name}`, name: name.replaceAll("_", " "), unit: "", t, values });
  }
  return found;
}

function robotSeries(run, robot, i) {
  const which = run.robots.length > 1 ? ` of ${robotName(run, i)}` : "";
  const row = (key, name, unit, values) =>
    ({ key: i ? `${key}/${i}` : key, name: name + which, unit, t: run.t, values });
  const rows = [
    row("speed", "speed", "m/s", robot.v),
    row("turn", "turn rate", "rad/s", robot.w),
  ];
  if (!run.people) return rows;
  return [row("clearance", "distance to the nearest person", "m", clearanceOf(run, robot)), ...rows];
}

function peopleSeries(run) {
  const { x, speed, count } = run.people;
  const present = new Float64Array(run.n);
  const mean = new Float64Array(run.n);
  for (let p = 0; p < count; p++) {
    for (let k = 0; k < run.n; k++) {
      if (x[p * run.n + k] === ABSENT) continue;
      present[k]++;
      mean[k] += speed[p * run.n + k];
    }
  }
  return [
    { key: "walking", name: "mean walking speed", unit: "m/s", t: run.t,
      values: mean.map((sum, k) => (present[k] ? sum / present[k] : NaN)) },
    { key: "people", name: "people present", unit: "", t: run.t, values: present },
  ];
}

const oneOf = (run, key) => run.series.find((series) => series.key === key);

/** Latest value of a series at a time; NaN before its first value. */
function valueAt(series, time) {
  const k = lastBefore(series.t, time);
  return k < 0 ? NaN : series.values[k];
}

/** An axis that holds all values: round ends, and round ticks between them. */
function axisOf(all) {
  let [low, high] = [Infinity, -Infinity];
  for (const { values } of all) {
    for (const v of values) {
      if (!Number.isFinite(v)) continue;
      low = Math.min(low, v);
      high = Math.max(high, v);
    }
  }
  if (low > high) return { low: 0, high: 1, ticks: [0, 1] };
  if (low > 0 && low < 0.5 * high) low = 0;
  if (high < 0 && high > 0.5 * low) high = 0;
  const span = high - low || Math.abs(high) || 1;
  const power = 10 ** Math.floor(Math.log10(span));
  const round = span / power < 2 ? power / 5 : span / power < 5 ? power / 2 : power;
  const ends = [Math.floor(low / round + 1e-9) * round, Math.ceil(high / round - 1e-9) * round];
  if (ends[1] <= ends[0]) ends[1] = ends[0] + round;
  return { low: ends[0], high: ends[1], ticks: ticksOf(...ends) };
}

/** Two to four multiples of a round number. */
function ticksOf(low, high) {
  const least = (high - low) / 3;
  const power = 10 ** Math.floor(Math.log10(least) + 1e-9);
  const apart = [1, 2, 5, 10].find((m) => m * power >= least * (1 - 1e-9)) * power;
  const ticks = [];
  for (let k = Math.ceil(low / apart - 1e-9); k * apart <= high + 1e-9 * apart; k++) ticks.push(k * apart);
  return ticks.length > 1 ? ticks : [low, high];
}
