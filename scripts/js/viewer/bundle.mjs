// Makes one script of scene.mjs: node bundle.mjs FOLDER_OF_NODE_MODULES OUT
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const [folder, out] = process.argv.slice(2);
const { build } = createRequire(join(folder, "x.js"))("esbuild");
const here = dirname(fileURLToPath(import.meta.url));
const den = join(here, "den.mjs");

/** Texts that webpack imports with ?raw, and what was never published. */
const plugin = {
  name: "viewer",
  setup(b) {
    b.onResolve({ filter: /^@foxglove\/den\// }, () => ({ path: den }));
    b.onResolve({ filter: /^@foxglove\/log$/ }, () => ({ path: "log", namespace: "log" }));
    b.onLoad({ filter: /.*/, namespace: "log" }, () => ({
      contents: `const quiet = () => {};
        const log = { debug: quiet, info: quiet, warn: console.warn, error: console.error };
        export default { getLogger: () => log };`,
    }));
    b.onResolve({ filter: /^three\/(examples\/jsm|src)\/[^?]*$/ }, (args) =>
      /\.(js|wasm)$/.test(args.path) ? undefined : { path: join(folder, `${args.path}.js`) },
    );
    b.onResolve({ filter: /\?raw$/ }, async (args) => {
      const path = args.path.replace(/\?raw$/, "");
      const found = await b.resolve(path, { resolveDir: args.resolveDir, kind: args.kind });
      return { path: found.path, namespace: "raw" };
    });
    b.onLoad({ filter: /.*/, namespace: "raw" }, (args) => ({
      contents: readFileSync(args.path), loader: "text",
    }));
  },
};

await build({
  entryPoints: [join(here, "scene.mjs")],
  bundle: true,
  outfile: out,
  format: "iife",
  nodePaths: [folder],
  plugins: [plugin],
  loader: { ".wasm": "binary", ".glsl": "text", ".svg": "dataurl", ".png": "dataurl" },
  define: { __filename: '"studio"', "process.env.NODE_ENV": '"production"', global: "globalThis", ReactNull: "null" },
  logLevel: "error",
});
