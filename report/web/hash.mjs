// Writes beside each file of the bundle the hash by which a browser knows that it may run it.
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";

for (const file of ["page.js", "page.css"]) {
  const path = new URL(`dist/${file}`, import.meta.url);
  writeFileSync(new URL(`dist/${file}.sha256`, import.meta.url), "sha256-" + createHash("sha256").update(readFileSync(path)).digest("base64"));
}
