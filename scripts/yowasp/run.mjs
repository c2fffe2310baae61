// SPDX-License-Identifier: Apache-2.0
// node run.mjs PACKAGES TOOL ARGUMENT...: a WebAssembly tool of the npm packages under the folder PACKAGES on real files. The
// packages know a virtual file system alone, so what the arguments name by absolute paths (folders: their files) is read
// into it before, and what has changed there is written back.
import { existsSync, mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [packages, tool, ...args] = process.argv.slice(2);
const home = tool === "yosys" ? "yosys" : "nextpnr-ice40";
const bundle = resolve(packages, "node_modules", "@yowasp", home, "gen", "bundle.js");
const { commands, Exit } = await import(pathToFileURL(bundle));

const tree = {};
const parts = (path) => path.split("/").filter((part) => part);
const folder = (path) => parts(path).reduce((at, part) => (at[part] ??= {}), tree);
const add = (path) => (folder(dirname(path))[parts(path).at(-1)] = new Uint8Array(readFileSync(path)));

for (const [path] of args.join(" ").matchAll(/(?<=^|[\s"=]|-I)\/[\w.\/+-]+/g)) {
  if (!existsSync(path)) {
    if (existsSync(dirname(path))) folder(dirname(path));
  } else if (statSync(path).isDirectory()) {
    for (const entry of readdirSync(path, { withFileTypes: true })) if (entry.isFile()) add(join(path, entry.name));
  } else {
    add(path);
  }
}

function writeBack(files, before, path) {
  for (const [name, entry] of Object.entries(files)) {
    const old = before?.[name];
    if (typeof entry === "string" || entry instanceof Uint8Array) {
      if (old && Buffer.compare(Buffer.from(old), Buffer.from(entry)) === 0) continue;
      mkdirSync(path, { recursive: true });
      writeFileSync(join(path, name), entry);
    } else {
      writeBack(entry, old, join(path, name));
    }
  }
}

const print = (stream) => (bytes) => bytes && stream.write(Buffer.from(bytes));
const before = structuredClone(tree);
try {
  const after = await commands[tool](args, tree, { stdout: print(process.stdout), stderr: print(process.stderr) });
  writeBack(after, before, "/");
} catch (error) {
  if (!(error instanceof Exit)) throw error;
  writeBack(error.files, before, "/");
  process.exitCode = error.code;
}
