// Measures the time from a key to the step of the simulation that used it.

const KEPT = 40;
const latency = { sent: new Map(), times: [], unsaid: [] };

/** Remembers when the hand moved, for a position of the stick. */
function noteSent(number, stamp) {
  latency.sent.set(number, stamp);
  if (latency.sent.size > KEPT) latency.sent.delete(latency.sent.keys().next().value);
}

/**
 * Handles the first use of a position: earlier ones were passed over. `at` is the time of the step,
 * ms since 1970; page and run are on one machine, so they share a clock, unless it was set meanwhile.
 */
function noteTaken(number, at) {
  const stamp = latency.sent.get(number);
  for (const earlier of [...latency.sent.keys()]) if (earlier <= number) latency.sent.delete(earlier);
  if (stamp === undefined) return;
  const roundTrip = performance.now() - stamp;
  const byClock = at - performance.timeOrigin - stamp;
  const ms = byClock >= 0 && byClock <= roundTrip ? byClock : roundTrip;
  if (ms < 0 || ms > 10000) return;
  latency.times.push(ms);
  latency.unsaid.push(Math.round(100 * ms) / 100);
  if (latency.times.length > KEPT) latency.times.shift();
}

/** Tells the run what was measured. */
function sayLatency() {
  if (latency.unsaid.length && send("latency", { ms: latency.unsaid.slice(0, KEPT) })) latency.unsaid.splice(0, KEPT);
}

function medianLatency() {
  const sorted = Float64Array.from(latency.times).sort();
  return sorted.length ? sorted[sorted.length >> 1] : NaN;
}
