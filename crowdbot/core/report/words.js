// Words for axes and their values: "ttca_dca weight" and "20" for `coeff` and `c20`.

/** Text of a label: the words of the suite if it has any. */
const wordOf = (axis, name) => axis.words[axis.labels.indexOf(name)] ?? name;

/** The same with the label itself, which ids of scenarios show. */
function wordAndLabel(axis, l) {
  const [word, name] = [axis.words[l], axis.labels[l]];
  return word === name ? name : `${word} (${name})`;
}

/** Name and unit of a score, for the title of an axis. */
function measureOf(series) {
  const variant = series.variant === "corrected" ? "" : `, ${words(series.variant)}`;
  return `${words(series.metric)}${variant}${series.unit === "1" ? "" : ` in ${series.unit}`}`;
}

/** Splits text into lines of at most this many letters; truncates the last one if it does not fit. */
function linesOf(text, letters, most) {
  const lines = [""];
  for (const word of text.split(" ")) {
    const last = lines.length - 1;
    if (!lines[last] || `${lines[last]} ${word}`.length <= letters) lines[last] = `${lines[last]} ${word}`.trim();
    else lines.push(word);
  }
  const kept = lines.slice(0, most).map((line) => (line.length > letters ? `${line.slice(0, letters - 1)}…` : line));
  if (lines.length > most && !kept[most - 1].endsWith("…")) kept[most - 1] = `${kept[most - 1].slice(0, letters - 1)}…`;
  return kept;
}
