// Runs PICT on each model in a list. The models come as JSON in the file of the first argument; the results go to
// standard output as JSON: for each model the rows that PICT makes, or null if PICT refuses the model.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [models, pict] = process.argv.slice(2);
const { PictRunner } = await import(pathToFileURL(pict));
const runner = await PictRunner.create();
const results = JSON.parse(readFileSync(models, "utf8")).map(({ parameters, subModels, constraintsText }) => {
  try {
    return runner.run(parameters, { subModels, constraintsText }).result.body;
  } catch {
    return null;
  }
});
process.stdout.write(JSON.stringify(results));
