// A JSON Schema on the first line, then a value on each line. Answers each by a line: "null" where it is valid, else
// the first error (instancePath, keyword, params, message).
const Ajv = require("ajv");
const lines = require("readline").createInterface({input: process.stdin});
let validate;
lines.on("line", (line) => {
  const value = JSON.parse(line);
  if (!validate) {
    validate = new Ajv({strict: false}).compile(value);
    return;
  }
  process.stdout.write(JSON.stringify(validate(value) ? null : validate.errors[0]) + "\n");
});
