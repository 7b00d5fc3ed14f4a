// SPDX-License-Identifier: MIT
//
// Spheres on a floor under a lamp, as the tables of examples/applications/rays: path_tables.cpp, light_table.cpp and bvh.cpp say what each row holds.

const kinds = { clay: 0, mirror: 1, glass: 2, metal: 3 };
const lampRadius = 0.34;
// Of hierarchy.sk and scattering.sk.
const [watertight, stack] = [0, 0];
const feature = { mirrors: 1, glass: 2, metals: 4, emitters: 16, sky: 128, lens: 1024, listed: 16384 };
const features = Object.values(feature).reduce((a, b) => a | b);

/** Colours are albedos, of metals the reflectance, of glass the tint. */
const materials = [
  { kind: 'clay', colour: [0.5, 0.48, 0.46] }, // the floor
  { kind: 'glass', colour: [0.98, 1, 0.99], ior: 1.5 },
  { kind: 'metal', colour: [0.95, 0.7, 0.32], roughness: 0.12 },
  { kind: 'mirror', colour: [0.92, 0.93, 0.95] },
  { kind: 'clay', colour: [0.04, 0.36, 0.4] },
  { kind: 'clay', colour: [0.7, 0.13, 0.08] },
  { kind: 'clay', colour: [0.8, 0.62, 0.22] },
  { kind: 'clay', colour: [0, 0, 0], emission: [30, 26, 20] }, // the lamp
];
const floor = 0;
const lamp = 7;

/** Large ones by hand, small ones where there is room. */
function spheresFrom(random) {
  const spheres = [
    { centre: [-0.62, 0.34, 0.1], radius: 0.34, material: 1 },
    { centre: [0.12, 0.42, -0.45], radius: 0.42, material: 2 },
    { centre: [0.8, 0.3, 0.12], radius: 0.3, material: 3 },
    { centre: [-0.9, 0.27, -0.75], radius: 0.27, material: 4 },
    { centre: [0.2, 0.17, 0.45], radius: 0.17, material: 5 },
    { centre: [-0.3, 2.1, 0.9], radius: lampRadius, material: lamp },
  ];
  for (let tries = 0; spheres.length < 30 && tries < 1000; ++tries) {
    const radius = 0.06 + 0.06 * random();
    const centre = [3.2 * random() - 1.6, radius, 2.6 * random() - 1.5];
    const isFree = spheres.every((s) => Math.hypot(...s.centre.map((x, c) => x - centre[c])) > s.radius + radius + 0.02);
    if (isFree) spheres.push({ centre, radius, material: 1 + Math.floor(random() * 6) });
  }
  return spheres;
}

/** Integers are stored in floats with a bias, so that no device takes their bits for a denormal number. */
const words = new DataView(new ArrayBuffer(4));
function packed(integer) {
  words.setInt32(0, integer + 0x40000001);
  return words.getFloat32(0);
}

/** A hierarchy of boxes, halved along its longest side; sorts the spheres. */
function hierarchyOf(spheres) {
  const nodes = [null];
  const boxOf = (list) => [0, 1, 2].map((c) => [Math.min(...list.map((s) => s.centre[c] - s.radius)) - 1e-5, Math.max(...list.map((s) => s.centre[c] + s.radius)) + 1e-5]);
  const order = [];
  const build = (index, list) => {
    const box = boxOf(list);
    if (list.length <= 2) {
      nodes[index] = { box, first: order.length, count: list.length };
      order.push(...list);
      return;
    }
    const sizes = box.map(([low, high]) => high - low);
    const axis = sizes.indexOf(Math.max(...sizes));
    const sorted = [...list].sort((a, b) => a.centre[axis] - b.centre[axis]);
    const first = nodes.push(null, null) - 2;
    nodes[index] = { box, first, count: 0 };
    build(first, sorted.slice(0, sorted.length >> 1));
    build(first + 1, sorted.slice(sorted.length >> 1));
  };
  build(0, spheres);
  return { nodes, order };
}

/** The scene and its hierarchy, whose nodes have two children. */
export function sceneOf(device, random) {
  const { nodes, order } = hierarchyOf(spheresFrom(random));
  const stream = (type, rows) => {
    const values = rows.flat();
    const made = device.stream(type, [rows.length]);
    made.write(type.startsWith('int') ? Int32Array.from(values) : Float32Array.from(values));
    return made;
  };
  const lampAt = order.find((s) => s.material === lamp).centre;
  const share = 1 / (4 * Math.PI * lampRadius * lampRadius); // of the lamp's light, per area
  const nothing = stream('float4', [[0, 0, 0, 0]]);
  const hierarchy = {
    nodes: stream('float4', nodes.flatMap(({ box, first, count }) => [[...box.map(([low]) => low), packed(first)], [...box.map(([, high]) => high), packed(count)]])),
    nodeCount: nodes.length,
    traversal: stack,
    test: watertight,
  };
  const shapes = {
    floats: stream('float4', order.flatMap(({ centre, radius, material }, id) => [[...centre, packed(id)], [radius, 0, 0, packed(material)], [0, 0, 0, packed(-1)]])),
    halves: stream('half4', [[0, 0, 0, 0]]),
    numbers: stream('int2', [[0, 0]]),
    triangles: false,
    spheres: true,
    contracted: true,
  };
  const planes = { rows: stream('float4', [[0, 1, 0, 0], [0, 0, 0, packed(floor)]]), count: 1, firstId: order.length, exist: true };
  const surfaces = {
    rows: stream('float4', materials.flatMap(({ kind, colour, emission = [0, 0, 0], ior = 1.5, roughness = 0 }, i) => [
      [...colour, packed(kinds[kind])],
      [...emission, packed(-1)],
      [ior, roughness, i === lamp ? share : 0, 0],
    ])),
    corners: nothing,
    texels: nothing,
    textures: stream('int4', [[0, 0, 0, 0]]),
  };
  const lights = {
    rows: stream('float4', [[...lampAt, packed(1)], [lampRadius, 0, 0, packed(0)], [0, 0, 0, 1], [...materials[lamp].emission, 1]]),
    count: 1,
    suns: 0,
    sky: { colour: [0.15, 0.2, 0.29], image: nothing, size: [0, 0], choice: 0 },
  };
  return { scene: { shapes, planes, materials: surfaces, lights, features }, hierarchy };
}
