// Bundles the page's program and style into crates/pages/assets, from which the Rust build includes them as text.
//
//   npm ci && npm run build
import { readFile, writeFile } from "node:fs/promises";
import { build } from "esbuild";

const out = "../crates/pages/assets/";
const result = await build({
  entryPoints: { report: "src/main.js" },
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  charset: "utf8",
  legalComments: "none",
  outdir: out,
  metafile: true,
  logLevel: "info",
});

// "</script" inside of a program would end the element that holds it
const program = await readFile(`${out}report.js`, "utf8");
await writeFile(`${out}report.js`, program.replaceAll("</script", "<\\/script"));

const used = new Set();
for (const file of Object.keys(result.metafile.inputs)) {
  const found = file.match(/node_modules\/((?:@[^/]+\/)?[^/]+)\//);
  if (found) used.add(found[1]);
}
let text = "Licences of the libraries that report.js and report.css contain.\n";
for (const name of [...used].sort()) {
  const { version, license, homepage } = JSON.parse(await readFile(`node_modules/${name}/package.json`, "utf8"));
  text += `\n${name} ${version} (${license}), ${homepage ?? ""}\n\n`;
  text += await readFile(`node_modules/${name}/LICENSE`, "utf8");
}
await writeFile(`${out}LICENSES`, text);
