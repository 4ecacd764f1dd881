// Validates a .glb with the Khronos validator: no errors, no warnings.
const { validateBytes } = require('gltf-validator');
const { readFileSync } = require('fs');

const file = process.argv[2];
validateBytes(new Uint8Array(readFileSync(file)), { maxIssues: 20 }).then(({ issues, info }) => {
  const { numErrors, numWarnings, messages } = issues;
  if (numErrors + numWarnings > 0 || info.animationCount !== 1) {
    console.error(file, JSON.stringify(messages, null, 1), `animations: ${info.animationCount}`);
    process.exit(1);
  }
  console.log(`gltf-validator: no errors, no warnings, ${info.totalVertexCount} vertices`);
});
