// Colours of the style sheet for drawing, and the switch between light and dark.

const BUCKETS = 16;
const RUN_COLOURS = 6;
let colours = {};

function readColours() {
  const style = getComputedStyle(document.documentElement);
  const read = (name) => style.getPropertyValue(`--${name}`).trim();
  const names = ["floor", "grid", "grid-strong", "wall", "ink", "muted", "robot", "robot-edge",
    "goal", "lidar", "sonar", "thought", "contact", "person-edge", "slow", "fast", "accent", "chosen"];
  colours = Object.fromEntries(names.map((n) => [n, read(n)]));
  colours.runs = Array.from({ length: RUN_COLOURS }, (_, i) => read(`run-${i}`));
  const channel = (hex, i) => parseInt(hex.slice(1 + 2 * i, 3 + 2 * i), 16);
  colours.ramp = Array.from({ length: BUCKETS }, (_, b) => {
    const mix = [0, 1, 2].map((i) => {
      const [a, z] = [channel(colours.slow, i), channel(colours.fast, i)];
      return Math.round(a + ((z - a) * b) / (BUCKETS - 1));
    });
    return `rgb(${mix.join(" ")})`;
  });
}

const colourOfRun = (index) => colours.runs[index % RUN_COLOURS];

const wantsDark = matchMedia("(prefers-color-scheme: dark)");

function isDark() {
  const chosen = document.documentElement.dataset.theme;
  return chosen ? chosen === "dark" : wantsDark.matches;
}

/** Shows the page in light or dark; "" follows the system. */
function setTheme(theme) {
  if (theme) document.documentElement.dataset.theme = theme;
  else delete document.documentElement.dataset.theme;
  byId("theme").setAttribute("aria-pressed", String(isDark()));
  readColours();
}
