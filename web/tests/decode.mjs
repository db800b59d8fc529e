// Bundles decode.test.ts and runs it: node decode.mjs OUT_FOLDER
import { build } from "esbuild";
import { spawnSync } from "node:child_process";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const out = join(process.argv[2], "decode.test.mjs");
await build({ entryPoints: [join(here, "decode.test.ts")], outfile: out, bundle: true, format: "esm", platform: "node", target: "node18" });
process.exit(spawnSync(process.execPath, ["--test", out], { stdio: "inherit" }).status ?? 1);
