// Reads a streamed SOG folder as PlayCanvas does: lod-meta.json with the engine's own class, and every chunk
// with splat-transform's reader. Prints what it found; exits with 1 if a leaf names something that does not
// exist, or if its splats lie elsewhere.
//   node read_levels.mjs FOLDER      with both packages in node_modules of the current folder
import { readFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const packages = resolve('node_modules'), folder = process.argv[2];
const from = (path) => import(pathToFileURL(join(packages, path)).href);
const { GSplatOctree } = await from('playcanvas/build/playcanvas/src/scene/gsplat-unified/gsplat-octree.js');
const { MemoryReadFileSystem, readSog } = await from('@playcanvas/splat-transform/dist/index.mjs');

const wrongs = [];
const expect = (holds, what) => { if (!holds) { wrongs.push(what); } };

const meta = JSON.parse(readFileSync(join(folder, 'lod-meta.json'), 'utf8'));
const octree = new GSplatOctree(join(folder, 'lod-meta.json'), meta);
expect(octree.lodLevels === meta.counts.length, 'lodLevels');

const chunks = new Map();  // by file: the columns of its splats
const readChunk = async (url) => {
    const inner = JSON.parse(readFileSync(url, 'utf8')), names = ['meta.json'];
    for (const part of Object.values(inner)) { names.push(...(part?.files ?? [])); }
    const system = new MemoryReadFileSystem();
    for (const name of names) { system.set(name, new Uint8Array(readFileSync(join(dirname(url), name)))); }
    return readSog(system, 'meta.json', { logging: 'silent' });
};
for (const { url } of octree.files) { chunks.set(url, await readChunk(url)); }
const environment = meta.environment ? (await readChunk(join(folder, meta.environment))).numRows : 0;
expect(!meta.environment || environment > 0, 'environment: has no splats');

const ranges = new Map(), counts = Array(octree.lodLevels).fill(0);
for (const node of octree.nodes) {
    const low = node.bounds.getMin(), high = node.bounds.getMax();
    node.lods.forEach((lod, level) => {
        if (lod.count === 0) { return; }
        const table = chunks.get(lod.file), what = `${lod.file}, ${lod.count} from ${lod.offset}`;
        counts[level] += lod.count;
        ranges.set(lod.file, [...(ranges.get(lod.file) ?? []), [lod.offset, lod.count]]);
        expect(lod.offset + lod.count <= table.numRows, `${what}: the chunk has ${table.numRows}`);
        for (const axis of ['x', 'y', 'z']) {
            const values = table.getColumnByName(axis).data.subarray(lod.offset, lod.offset + lod.count);
            expect(values.every((value) => value >= low[axis] && value <= high[axis]), `${what}: ${axis} leaves the bound`);
        }
    });
}
expect(counts.join() === meta.counts.join(), `counts: ${counts} of ${meta.counts}`);
for (const [file, parts] of ranges) {  // they cover their chunk, and do not overlap
    let end = 0;
    for (const [offset, count] of parts.sort((a, b) => a[0] - b[0])) {
        expect(offset === end, `${file}: splats ${end} to ${offset}`);
        end = offset + count;
    }
    expect(end === chunks.get(file).numRows, `${file}: splats from ${end} on`);
}
// The format requires a value for each level, never below the one before.
const leavesOf = (node) => (node.lods ? [node] : node.children.flatMap(leavesOf));
for (const { errors } of meta.lodErrors ? leavesOf(meta.tree) : []) {
    expect(errors.length === meta.lodLevels && errors[0] === 0 && errors.every((e, i) => i === 0 || e >= errors[i - 1]), `errors: ${errors}`);
}
for (const wrong of wrongs.slice(0, 10)) { console.log(`wrong: ${wrong}`); }
console.log(`${octree.nodes.length} leaves, ${octree.files.length} chunks, levels of ${counts.join(', ')} splats, environment of ${environment}; ${wrongs.length} wrongs`);
process.exit(wrongs.length === 0 ? 0 : 1);
