// SPDX-License-Identifier: Apache-2.0
// Khronos' validator over glTF files, from a folder with node_modules (npm install gltf-validator):
//   node PATH/validate.mjs FILE.glb ...
// Ends with 1 on an error or warning.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const validator = createRequire(`${process.cwd()}/`)('gltf-validator');

let bad = 0;
for (const file of process.argv.slice(2)) {
    const { issues, info } = await validator.validateBytes(new Uint8Array(readFileSync(file)), { maxIssues: 0 });
    console.log(`${file}: ${issues.numErrors} errors, ${issues.numWarnings} warnings, ${issues.numInfos} notes; ` +
                `${info.totalVertexCount} vertices, ${info.totalTriangleCount} triangles`);
    bad += issues.numErrors + issues.numWarnings;
}
process.exitCode = bad > 0 ? 1 : 0;
