// Validate files: node validate.js FILE... prints a JSON list of what is wrong with each.
const fs = require("fs");

async function validate(path) {
  if (path.endsWith(".glb")) {
    const { validateBytes } = require("gltf-validator");
    const report = await validateBytes(new Uint8Array(fs.readFileSync(path)), { maxIssues: 20 });
    return report.issues.messages.filter((one) => one.severity < 2).map((one) => one.message);
  }
  const { check } = require("@placemarkio/check-geojson");
  try {
    check(fs.readFileSync(path, "utf8"));
    return [];
  } catch (error) {
    return error.issues ? error.issues.map((one) => one.message) : [String(error)];
  }
}

Promise.all(process.argv.slice(2).map(validate)).then((found) => console.log(JSON.stringify(found)));
