// Words for axes and their values: "ttca_dca weight" and "20" for `coeff` and `c20`.

/** Texts of a label: the words of the suite where there are some. */
const wordOf = (axis, name) => axis.words[axis.labels.indexOf(name)] ?? name;

/** The same with the label itself, which ids of scenarios show. */
function wordAndLabel(axis, l) {
  const [word, name] = [axis.words[l], axis.labels[l]];
  return word === name ? name : `${word} (${name})`;
}

/** What a score is measured in, for the title of a picture's axis. */
function measureOf(series) {
  const variant = series.variant === "corrected" ? "" : `, ${words(series.variant)}`;
  return `${words(series.metric)}${variant}${series.unit === "1" ? "" : ` in ${series.unit}`}`;
}

/** Text in lines of at most so many letters; the last one is cut where there is no room. */
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
