// Writes the part of three.js that the pages use: node bundle.mjs [OUT]; npm ci --prefix scripts/js before.
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, "..", "..", "..", "crowdbot", "core", "replay", "three.min.js");
await build({
  entryPoints: [join(here, "names.mjs")],
  bundle: true,
  minify: true,
  format: "iife",
  globalName: "THREE",
  outfile: out,
  legalComments: "inline",
  charset: "ascii",
  logLevel: "error",
});
