// Texts of a planner in three dimensions: signs that face the eye, in front of everything.

const SIGN_HEIGHT = 0.3; // m; of a line of text, and of its middle above the floor
const SIGN_PIXELS = 64; // height of its picture
const MOST_SIGNS = 200; // texts that are kept painted

function makeSigns() {
  const group = new THREE.Group();
  group.userData.painted = new Map();
  return group;
}

/** Returns the material with a text, painted once. */
function paintedSign({ userData: { painted } }, text) {
  const known = painted.get(text);
  if (known) return known;
  const canvas = document.createElement("canvas");
  const g = canvas.getContext("2d");
  const font = `600 ${0.7 * SIGN_PIXELS}px system-ui, sans-serif`;
  g.font = font;
  canvas.width = Math.ceil(g.measureText(text).width) + 16;
  canvas.height = SIGN_PIXELS;
  Object.assign(g, { font, textBaseline: "middle", lineJoin: "round", lineWidth: 12, strokeStyle: colours.floor, fillStyle: colours.thought });
  g.strokeText(text, 8, SIGN_PIXELS / 2);
  g.fillText(text, 8, SIGN_PIXELS / 2);
  const map = new THREE.CanvasTexture(canvas);
  const material = new THREE.SpriteMaterial({ map, depthTest: false, fog: false });
  material.userData.wide = canvas.width / canvas.height;
  painted.set(text, material);
  return material;
}

/** Forgets what is painted: colours have changed, or there is too much. */
function clearSigns({ userData: { painted } }) {
  for (const material of painted.values()) {
    material.map.dispose();
    material.dispose();
  }
  painted.clear();
}

/** Shows the texts of the latest drawing of each name. */
function moveSigns(group, run, { time }, shows) {
  if (group.userData.painted.size > MOST_SIGNS) clearSigns(group);
  let n = 0;
  for (const { t, starts, rows, which, texts, columns: [x, y] } of shows ? run.drawings ?? [] : []) {
    const j = lastBefore(t, time);
    if (!which || j < 0 || time - t[j] > THOUGHT_AGE) continue;
    for (let i = starts[j]; i < starts[j] + rows[j]; i++) {
      if (!texts[which[i]]) continue;
      const material = paintedSign(group, texts[which[i]]);
      if (!group.children[n]) group.add(new THREE.Sprite(material));
      const sign = group.children[n++];
      sign.material = material;
      sign.position.set(x[i], y[i], SIGN_HEIGHT);
      sign.scale.set(SIGN_HEIGHT * material.userData.wide, SIGN_HEIGHT, 1);
    }
  }
  group.children.forEach((sign, k) => (sign.visible = k < n));
}
