// SPDX-License-Identifier: Apache-2.0
// Draws an export in three.js in headless Chromium, and compares its mean colour with a picture of sward render.
//   npm install three puppeteer-core
//   texgen export SET -o out/textures --for textures;  texgen export SET -o out/gltf --for gltf
//   CHROMIUM=/usr/bin/chromium node three_check.mjs OUT_FOLDER MODULES_FOLDER PICTURES_FOLDER [R G B]
// R G B: linear means of sward render's EXR from above (three_reference.py). Ends with 1 where one of them is off by more than 3 %.
import { createServer } from 'node:http';
import { mkdir, readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const [out, modules, pictures, ...expected] = process.argv.slice(2);
const puppeteer = createRequire(path.resolve(modules, 'x.js'))('puppeteer-core');
await mkdir(pictures, { recursive: true });
const here = path.dirname(fileURLToPath(import.meta.url));
const kinds = { '.html': 'text/html', '.js': 'text/javascript', '.json': 'application/json', '.wasm': 'application/wasm' };
const server = createServer(async (request, response) => {
    const name = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
    const file = name.startsWith('/modules/') ? path.join(modules, name.slice(9)) : name === '/three.html' ? path.join(here, name) : path.join(out, name);
    try {
        const data = await readFile(file);
        response.writeHead(200, { 'content-type': kinds[path.extname(file)] ?? 'application/octet-stream' });
        response.end(data);
    } catch {
        response.writeHead(404).end();
    }
}).listen(0, '127.0.0.1');
const browser = await puppeteer.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'],
});

async function draw(what, picture) {
    const page = await browser.newPage();
    page.on('console', line => { if (!/GPU stall|DevTools/.test(line.text())) console.log('  page:', line.text().slice(0, 300)); });
    page.on('pageerror', error => console.log('  page error:', error.message));
    await page.setViewport({ width: 640, height: 640 });
    await page.goto(`http://127.0.0.1:${server.address().port}/three.html?${what}`);
    await page.waitForFunction('window.result', { timeout: 240000 });
    const result = await page.evaluate('window.result');
    if (!result.error)
        await (await page.$('canvas')).screenshot({ path: path.join(pictures, picture) });
    await page.close();
    return result;
}

let bad = false;
try {
    const mesh = await draw('show=mesh', 'three-mesh.png');
    console.log('mesh:', JSON.stringify(mesh));
    const means = [];
    for (const variant of [0, 1]) {
        const layers = await draw(`show=layers&variant=${variant}`, `three-layers${variant}.png`);
        console.log(`layers of variant ${variant}:`, JSON.stringify(layers));
        bad ||= Boolean(layers.error);
        means.push(layers.mean);
    }
    bad ||= Boolean(mesh.error);
    if (!bad && expected.length === 3)
        for (let c = 0; c < 3; ++c) {
            const mean = (means[0][c] + means[1][c]) / 2, off = mean / Number(expected[c]) - 1;
            console.log(`${'RGB'[c]}: three.js ${mean.toFixed(4)}, sward ${Number(expected[c]).toFixed(4)}, ${(100 * off).toFixed(2)} %`);
            bad ||= Math.abs(off) > 0.03;
        }
} finally {
    await browser.close();
    server.close();
}
process.exitCode = bad ? 1 : 0;
