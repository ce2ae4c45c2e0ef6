// Runs a TensorFlow.js graph model on images: the original runtime that compare.py holds the ONNX files against.
//
// node tfjs_run.mjs MODEL.json SIZE COUNT IMAGES OUT TENSOR.. reads COUNT images of SIZE x SIZE x 3 bytes from the file
// IMAGES. It writes the tensors of the first image, then of the second image, and so on, to the file OUT as float32.
// The model's own type of numbers decides whether it gets whole numbers. Needs the packages in the working directory.

import { createRequire } from "node:module";
import fs from "node:fs";
import path from "node:path";

const require = createRequire(path.join(process.cwd(), "package.json"));
const tf = require("@tensorflow/tfjs");
const wasm = require("@tensorflow/tfjs-backend-wasm");

const [model, sizeText, countText, images, out, ...tensors] = process.argv.slice(2);
const [size, count] = [Number(sizeText), Number(countText)];

wasm.setWasmPaths(path.join(path.dirname(require.resolve("@tensorflow/tfjs-backend-wasm/package.json")), "dist") + "/");
await tf.setBackend("wasm");

const contents = JSON.parse(fs.readFileSync(model));
const files = contents.weightsManifest.flatMap((group) => group.paths);
const weights = Buffer.concat(files.map((file) => fs.readFileSync(path.join(path.dirname(model), file))));
const graph = await tf.loadGraphModel({
  load: async () => ({
    modelTopology: contents.modelTopology,
    signature: contents.signature,
    weightSpecs: contents.weightsManifest.flatMap((group) => group.weights),
    weightData: new Uint8Array(weights).buffer,
  }),
});

const loops = contents.modelTopology.node.some((node) => node.op === "LoopCond");
const pixels = fs.readFileSync(images);
const bytes = size * size * 3;
const file = fs.openSync(out, "w");
for (let index = 0; index < count; index++) {
  const values = Array.from(pixels.subarray(index * bytes, (index + 1) * bytes));
  const image = tf.tensor(values, [1, size, size, 3], graph.inputs[0].dtype);
  const results = loops ? await graph.executeAsync(image, tensors) : graph.execute(image, tensors);
  for (const tensor of [results].flat()) fs.writeSync(file, new Uint8Array((await tensor.data()).slice().buffer));
  tf.dispose([image, results]);
}
fs.closeSync(file);
