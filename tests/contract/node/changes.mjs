// Prints, as JSON, what has changed between two OpenAPI documents: node changes.mjs BEFORE AFTER
import { readFileSync } from "node:fs";
import { apiCompare } from "api-smart-diff";
import { load } from "js-yaml";

const [before, after] = process.argv.slice(2).map((path) => load(readFileSync(path, "utf8")));
const { diffs } = apiCompare(before, after);
console.log(JSON.stringify(diffs.map(({ action, type, path }) => ({ action, type, path }))));
