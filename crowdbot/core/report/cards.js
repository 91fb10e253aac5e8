// Metric cards: shown while the pointer is over a metric's name or the card, or the name has focus.

function buildCards() {
  const card = byId("card");
  let owner = null;
  let leaving = 0;
  const open = (button) => {
    clearTimeout(leaving);
    owner?.removeAttribute("aria-describedby");
    owner = button;
    card.replaceChildren(...cardOf(Number(button.dataset.card)));
    card.hidden = false;
    button.setAttribute("aria-describedby", "card");
    placeCard(card, button);
  };
  const close = () => {
    card.hidden = true;
    owner?.removeAttribute("aria-describedby");
    owner = null;
  };
  const later = () => {
    clearTimeout(leaving);
    leaving = setTimeout(() => owner && owner !== document.activeElement && close(), 160);
  };
  const named = (event) => event.target.closest?.("[data-card]");
  document.addEventListener("pointerover", (event) => {
    const button = named(event);
    if (button && button !== owner) {
      clearTimeout(leaving);
      leaving = setTimeout(() => open(button), 120);
    } else if (button) clearTimeout(leaving);
    else if (card.contains(event.target)) clearTimeout(leaving);
  });
  document.addEventListener("pointerout", (event) => {
    if (named(event) || card.contains(event.target)) later();
  });
  document.addEventListener("focusin", (event) => (named(event) ? open(named(event)) : close()));
  document.addEventListener("keydown", (event) => event.key === "Escape" && close());
  document.addEventListener("scroll", () => owner && placeCard(card, owner), { passive: true });
}

function cardOf(s) {
  const series = report.series[s];
  const about = report.cards[series.metric];
  const heading = el("h3", {}, words(series.metric), " ", el("i", { text: series.symbol }));
  if (!about) return [heading, el("p", { text: "This metric is not installed here, so there is no card." })];
  const rows = about.head.map(([name, text]) => el("div", {}, el("dt", { text: name }), el("dd", {}, marked(text))));
  const variant = about.variants[series.variant];
  return [
    heading, el("p", {}, marked(about.summary)), about.formula ? el("pre", {}, marked(about.formula)) : null,
    variant ? el("p", {}, el("b", { text: `${words(series.variant)}: ` }), marked(variant)) : null,
    el("dl", {}, rows),
    about.literal ? el("p", { class: "muted" }, el("b", { text: "Literal form: " }), marked(about.literal)) : null,
  ].filter(Boolean);
}

/** Splits text into plain parts and `code`. */
function marked(text) {
  return text.split("`").map((part, i) => (i % 2 ? el("code", { text: part }) : part));
}

/** Places the card below the name if there is room, else above. */
function placeCard(card, button) {
  const box = button.getBoundingClientRect();
  const { offsetWidth: width, offsetHeight: height } = card;
  const left = Math.min(Math.max(8, box.left), document.documentElement.clientWidth - width - 8);
  const below = box.bottom + 6 + height < innerHeight || box.top < height;
  card.style.left = `${Math.max(8, left)}px`;
  card.style.top = `${Math.max(8, below ? Math.min(box.bottom + 6, innerHeight - height - 8) : box.top - height - 6)}px`;
}
