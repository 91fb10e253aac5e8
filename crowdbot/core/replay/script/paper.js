// Printing: in light colours, drawn for the size of the sheet, so that circles stay circles.

const SHEET = 1000; // px that stand for the width of a sheet

function toPaper() {
  shown.onPaper = { theme: document.documentElement.dataset.theme ?? "" };
  setTheme("light");
  const columns = Math.min(2, shown.runs.length);
  const width = SHEET / columns;
  shown.wide.size = { width: SHEET, height: Math.round(clamp(SHEET / shown.ratio, 60, 500)), ratio: 2 };
  for (const { view } of shown.panels) {
    view.size = { width, height: Math.round((columns === 1 ? 0.5 : 0.7) * width), ratio: 2 };
  }
  writeLegend();
  writeClock();
  paint();
}

function fromPaper() {
  if (!shown.onPaper) return;
  setTheme(shown.onPaper.theme);
  delete shown.onPaper;
  for (const view of [shown.wide, ...shown.panels.map((panel) => panel.view)]) delete view.size;
  paint();
}
