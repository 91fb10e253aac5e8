// Lints the scripts of each page as the browser gets them: joined, in the order of its page.py.
// Alone, one file's functions would be unused and those of the others unknown.

import { readFileSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import js from "@eslint/js";
import { Linter } from "eslint";
import globals from "globals";

const ROOT = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const PAGES = [
  "crowdbot/core/replay/page.py", "crowdbot/core/report/page.py", "crowdbot/core/live/person/page.py",
  "crowdbot/core/editor/page.py",
];
const CONFIG = {
  languageOptions: { ecmaVersion: 2022, sourceType: "script", globals: { ...globals.browser, THREE: "readonly" } },
  linterOptions: { reportUnusedDisableDirectives: "error" },
  rules: {
    ...js.configs.recommended.rules,
    "consistent-return": "error",
    curly: ["error", "multi-line"],
    eqeqeq: "error",
    "no-eval": "error",
    "no-implied-eval": "error",
    "no-shadow": "error",
    "no-unneeded-ternary": "error",
    "no-use-before-define": ["error", { functions: false, variables: false }],
    "no-var": "error",
    "object-shorthand": "error",
    "prefer-const": "error",
    "prefer-template": "error",
    strict: ["error", "global"],
  },
};

/** A page's scripts, in the order in which they run; `own`: not shared with the replay page. */
function scriptsOf(page) {
  const text = readFileSync(join(ROOT, page), "utf-8");
  const named = (list) => {
    const names = new RegExp(`^${list} = \\(([^)]*)\\)`, "m").exec(text);
    return names && [...names[1].matchAll(/"([^"]+)"/g)].map((m) => m[1].replace(/(\.js)?$/, ".js"));
  };
  const all = named("_SCRIPTS");
  if (all) return all.map((name) => ({ file: join(ROOT, dirname(page), name), own: true }));
  const [shared, own] = [named("_SHARED"), named("_OWN")];
  if (!shared || !own) throw new Error(`${page} has neither _SCRIPTS nor _SHARED and _OWN`);
  return [
    ...shared.map((name) => ({ file: join(ROOT, "crowdbot/core/replay/script", name), own: false })),
    ...own.map((name) => ({ file: join(ROOT, dirname(page), "script", name), own: true })),
  ];
}

/** What is wrong in one page, with the file and line that each message belongs to. */
function lint(page) {
  const starts = [];
  let text = "";
  for (const { file, own } of scriptsOf(page)) {
    starts.push({ file, own, line: text.split("\n").length });
    text += `${readFileSync(file, "utf-8")}\n`;
  }
  return new Linter().verify(text, CONFIG).flatMap((message) => {
    const { file, line, own } = starts.findLast((start) => start.line <= message.line);
    if (!own && message.ruleId === "no-unused-vars") return []; // used on the page that owns it
    const where = `${relative(ROOT, file)}:${message.line - line + 1}:${message.column}`;
    return `${where}: ${message.message} (${message.ruleId})`;
  });
}

const found = PAGES.flatMap(lint);
for (const message of found) console.log(message);
process.exitCode = found.length > 0 ? 1 : 0;
