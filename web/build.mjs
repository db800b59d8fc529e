// Bundles the page and writes it as one C++ source: node build.mjs PAGE_FILES.cpp
import { build } from "esbuild";
import { writeFileSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2];
if (!out) throw new Error("usage: node build.mjs PAGE_FILES.cpp");

const bundle = await build({
  entryPoints: { page: join(here, "src/main.ts") },
  outdir: "/unused", // nothing is written
  bundle: true,
  minify: true,
  format: "esm",
  target: ["chrome100", "firefox100", "safari15.4"],
  legalComments: "inline", // three.js and uPlot keep their licenses
  write: false,
});
const built = (suffix) => bundle.outputFiles.find((file) => file.path.endsWith(suffix)).contents;
const files = [
  ["/", "text/html; charset=utf-8", readFileSync(join(here, "src/page.html"))],
  ["/page.js", "text/javascript; charset=utf-8", built(".js")],
  ["/page.css", "text/css; charset=utf-8", built(".css")],
];

let source = '#include "view/page_files.h"\n\n// Written by web/build.mjs.\n\nnamespace lamella::app::view {\nnamespace {\n\n';
files.forEach(([, , bytes], i) => {
  source += `constexpr unsigned char kFile${i}[] = {${Array.from(bytes).join(",")}};\n`;
});
source += "\n}  // namespace\n\nstd::span<const PageFile> page_files() {\n    static const PageFile files[] = {\n";
files.forEach(([path, type, bytes], i) => {
  source += `        {"${path}", "${type}", {reinterpret_cast<const char*>(kFile${i}), ${bytes.length}}},\n`;
});
source += "    };\n    return files;\n}\n\n}  // namespace lamella::app::view\n";
writeFileSync(out, source);
