// SPDX-License-Identifier: MIT
//
// Draws a cloth and a ball, or another surface, in a canvas with a WebGL2 context of its own: positions and normals come from the host, as the runtime does not
// hand out textures.

const vertexText = `#version 300 es
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 normalIn;
uniform mat4 camera;
uniform vec4 moved;      // of a ball: its centre, and its radius
uniform int columns, rows;
out vec3 at, normal;
out vec2 place;
void main() {
  at = moved.w > 0.0 ? moved.xyz + moved.w * position.xyz : position.xyz;
  normal = normalIn.xyz;
  place = vec2(gl_VertexID % columns, gl_VertexID / columns) / vec2(max(columns - 1, 1), max(rows - 1, 1));
  gl_Position = camera * vec4(at, 1);
}
`;

const fragmentText = `#version 300 es
precision highp float;
in vec3 at, normal;
in vec2 place;
uniform vec3 eye;
uniform bool isBall, isPlain;
out vec4 colour;
float stripes(float x) {
  float w = max(fwidth(x), 1e-4);
  return clamp((abs(fract(x) - 0.5) - 0.25) / w + 0.5, 0.0, 1.0);
}
void main() {
  vec3 view = normalize(eye - at), n = normalize(normal);
  bool isBack = dot(n, view) < 0.0;
  if (isBack) n = -n;
  vec3 sun = normalize(vec3(-0.45, 0.75, 0.6));
  float facing = dot(n, sun);
  vec3 body = vec3(0.86, 0.55, 0.16);
  if (isPlain) {
    body = vec3(0.16, 0.5, 0.55);
  } else if (!isBall) {
    body = mix(vec3(0.05, 0.36, 0.42), vec3(0.93, 0.88, 0.78), stripes(6.0 * place.x));
    if (place.y > 0.94) body = vec3(0.78, 0.28, 0.2);
    if (isBack) body *= 0.8;
  }
  float through = isBall ? 0.0 : 0.18 * max(-facing, 0.0); // a thin cloth lets light through
  float sky = 0.5 + 0.5 * n.y;
  vec3 light = vec3(1.08, 1.02, 0.92) * (max(facing, 0.0) + through) + mix(vec3(0.20, 0.18, 0.18), vec3(0.42, 0.47, 0.55), sky);
  vec3 halfway = normalize(sun + view);
  float gleam = isBall || isPlain ? 0.35 * pow(max(dot(n, halfway), 0.0), 60.0) : 0.06 * pow(max(dot(n, halfway), 0.0), 12.0);
  colour = vec4(pow(body * body * light + gleam, vec3(0.5)), 1);
}
`;

const groundText = `#version 300 es
precision highp float;
uniform vec2 size;
out vec4 colour;
void main() {
  vec2 p = gl_FragCoord.xy / size;
  vec3 c = mix(vec3(0.60, 0.64, 0.68), vec3(0.80, 0.85, 0.90), smoothstep(0.0, 1.0, p.y));
  colour = vec4(c * (1.0 - 0.22 * dot(p - 0.5, p - 0.5) * 2.0), 1);
}
`;
const groundVertexText = `#version 300 es
void main() { gl_Position = vec4(float(gl_VertexID & 1) * 4.0 - 1.0, float(gl_VertexID & 2) * 2.0 - 1.0, 0.999, 1); }
`;

function programOf(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [stage, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(stage);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) throw new Error(`a program of the picture does not link: ${gl.getProgramInfoLog(program)}`);
  return program;
}

/** Points of a sphere of radius 1, row by row, as positions with a fourth component, which are its normals, too. */
function spherePoints(rows, columns) {
  return Float32Array.from({ length: 4 * rows * columns }, (_, i) => {
    const [n, c] = [i >> 2, i & 3];
    const [down, around] = [(Math.PI * Math.floor(n / columns)) / (rows - 1), (2 * Math.PI * (n % columns)) / (columns - 1)];
    return [Math.sin(down) * Math.sin(around), Math.cos(down), Math.sin(down) * Math.cos(around), 1][c];
  });
}

/** Two triangles for each cell, but where `faces` (1: the upper left one, 2: the other) leaves one out. */
function trianglesOf(rows, columns, faces) {
  const list = [];
  for (let y = 0; y + 1 < rows; ++y) {
    for (let x = 0; x + 1 < columns; ++x) {
      const i = y * columns + x;
      const whole = faces(i);
      if (whole & 1) list.push(i, i + columns, i + 1);
      if (whole & 2) list.push(i + 1, i + columns, i + columns + 1);
    }
  }
  return new Uint16Array(list);
}

export class MeshView {
  /** A camera at `eye` that looks along -z; `tall`: the height that it sees at a distance of 1. */
  constructor(canvas, eye, tall) {
    Object.assign(this, { canvas, eye, tall });
    const gl = canvas.getContext('webgl2', { antialias: true, preserveDrawingBuffer: true });
    if (gl === null) throw new Error('the browser gives no second WebGL2 context, for the picture');
    this.gl = gl;
    this.program = programOf(gl, vertexText, fragmentText);
    this.ground = programOf(gl, groundVertexText, groundText);
    this.at = (name) => gl.getUniformLocation(this.program, name);
    this.ball = this.mesh(24, 48);
    const points = spherePoints(24, 48);
    this.fill(this.ball, points, points);
  }

  mesh(rows, columns) {
    const { gl } = this;
    const mesh = { rows, columns, array: gl.createVertexArray(), buffers: [gl.createBuffer(), gl.createBuffer()], indices: gl.createBuffer(), count: 0 };
    gl.bindVertexArray(mesh.array);
    mesh.buffers.forEach((buffer, i) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.enableVertexAttribArray(i);
      gl.vertexAttribPointer(i, 4, gl.FLOAT, false, 0, 0);
    });
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, mesh.indices);
    return mesh;
  }

  fill(mesh, positions, normals, faces = () => 3) {
    const { gl } = this;
    gl.bindVertexArray(mesh.array);
    [positions, normals].forEach((data, i) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, mesh.buffers[i]);
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    });
    const triangles = trianglesOf(mesh.rows, mesh.columns, faces);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.DYNAMIC_DRAW);
    mesh.count = triangles.length;
  }

  /** From places in space to clip space, column by column. */
  camera() {
    const [near, far, [x, y, z]] = [0.5, 12, this.eye];
    const up = 2 / this.tall;
    const right = (up * this.canvas.height) / this.canvas.width;
    const [a, b] = [-(far + near) / (far - near), (-2 * far * near) / (far - near)];
    return [right, 0, 0, 0, 0, up, 0, 0, 0, 0, a, -1, -right * x, -up * y, -a * z + b, z];
  }

  /** Where a point is in the picture, from 0 to 1, and how far away. */
  project([x, y, z]) {
    const distance = this.eye[2] - z;
    const high = this.tall * distance;
    const wide = (high * this.canvas.width) / this.canvas.height;
    return [0.5 + (x - this.eye[0]) / wide, 0.5 - (y - this.eye[1]) / high, distance];
  }

  /** The point at this place of the picture, and this far away. */
  unproject(x, y, distance) {
    const high = this.tall * distance;
    const wide = (high * this.canvas.width) / this.canvas.height;
    return [this.eye[0] + (x - 0.5) * wide, this.eye[1] + (0.5 - y) * high, this.eye[2] - distance];
  }

  /** Without a ball, the surface has one colour. */
  draw(surface, ball = null) {
    const { gl, canvas } = this;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.disable(gl.DEPTH_TEST);
    gl.bindVertexArray(null);
    gl.useProgram(this.ground);
    gl.uniform2f(gl.getUniformLocation(this.ground, 'size'), canvas.width, canvas.height);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.program);
    gl.uniformMatrix4fv(this.at('camera'), false, this.camera());
    gl.uniform3fv(this.at('eye'), this.eye);
    gl.uniform1i(this.at('isPlain'), Number(ball === null));
    const balls = ball === null ? [] : [[this.ball, [...ball.centre, ball.radius]]];
    for (const [mesh, moved] of [...balls, [surface, [0, 0, 0, 0]]]) {
      gl.bindVertexArray(mesh.array);
      gl.uniform4fv(this.at('moved'), moved);
      gl.uniform1i(this.at('isBall'), Number(mesh === this.ball));
      gl.uniform1i(this.at('columns'), mesh.columns);
      gl.uniform1i(this.at('rows'), mesh.rows);
      gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_SHORT, 0);
    }
  }
}
