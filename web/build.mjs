// Bundles the page: the same sources and the same package-lock.json give the same bytes.
// `node build.mjs FOLDER` writes the files of the page into FOLDER.
import { build } from "esbuild";
import { copyFile, mkdir, readFile, readdir, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const folder = process.argv[2];
if (!folder) throw new Error("say where to: node build.mjs FOLDER");

await mkdir(folder, { recursive: true });
const result = await build({
  absWorkingDir: here,
  entryPoints: ["src/page.tsx", "src/page.css"],
  outdir: folder,
  bundle: true,
  minify: true,
  format: "esm",
  target: ["es2022"],
  charset: "utf8",
  legalComments: "none", // licences.txt has them whole
  metafile: true,
  logLevel: "warning",
});
for (const name of ["index.html", "icon.svg"]) await copyFile(join(here, "src", name), join(folder, name));
await writeFile(join(folder, "licences.txt"), await licences(Object.keys(result.metafile.inputs)));

/** The licences of all packages that a file was taken from. */
async function licences(inputs) {
  const packages = inputs.map((path) => /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(path)?.[1]).filter(Boolean);
  const texts = [...new Set(packages)].sort().map(licence);
  return (await Promise.all(texts)).join("\n\n");
}

async function licence(name) {
  const place = join(here, "node_modules", name);
  const about = JSON.parse(await readFile(join(place, "package.json"), "utf8"));
  const file = (await readdir(place)).sort().find((entry) => /^licen[sc]e/i.test(entry));
  const text = file ? await readFile(join(place, file), "utf8") : `Licence: ${about.license}`;
  return `${name} ${about.version}\n\n${text.trim()}\n`;
}
