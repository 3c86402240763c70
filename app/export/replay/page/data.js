// The recording: unpacks the block of bytes and hands out the numbers of a frame.

async function unpack(text) {
  const packed = Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

// The inverse of differences() in quantise.cpp.
function sumDifferences(planes, count, columns, byLine) {
  const values = new Uint16Array(count);
  for (let i = 0; i < count; ++i) {
    const folded = planes[i] | planes[count + i] << 8;
    const difference = folded & 1 ? -(folded + 1) / 2 : folded / 2;
    let foretold = 0;
    if (i >= columns) foretold = values[i - columns];
    if (byLine && i >= 2 * columns) foretold = 2 * foretold - values[i - 2 * columns];
    values[i] = foretold + difference;
  }
  return values;
}

class Recording {
  constructor(header, buffer) {
    this.header = header;
    this.buffer = buffer;
    this.frameCount = header.frames;
    this.vertexCount = header.meshes.reduce((sum, mesh) => sum + mesh.vertices, 0);
    this.quantised = this.stream("positions");
    this.positions = new Float32Array(3 * this.vertexCount);
    this.shares = this.stream("shares");
    this.cameras = this.stream("cameras");
    this.particles = this.readMarks("particles");
    this.contacts = this.readMarks("contacts");
    this.normals = this.stream("contacts_normals");
    this.joinMeshes();
  }

  stream(name) {
    const { kind, offset, count, columns } = this.header.streams[name];
    switch (kind) {
      case "u8": return new Uint8Array(this.buffer, offset, count);
      case "u16": return new Uint16Array(this.buffer, offset, count);
      case "u32": return new Uint32Array(this.buffer, offset, count);
      case "f32": return new Float32Array(this.buffer, offset, count);
      default: {
        const planes = new Uint8Array(this.buffer, offset, 2 * count);
        return sumDifferences(planes, count, columns, kind === "differences_by_line");
      }
    }
  }

  readMarks(name) {
    const counts = this.stream(name + "_counts");
    const begins = new Uint32Array(counts.length + 1);
    counts.forEach((count, frame) => { begins[frame + 1] = begins[frame] + count; });
    return { begins, places: this.stream(name + "_places"), looks: this.stream(name + "_looks") };
  }

  // Each mesh with its triangles, by its own vertices' numbers, and the numbers of their corners' normals, where some
  // share one; of all meshes as one the triangles of smooth ones, the edges, and the vertices' colours with their
  // roughness.
  joinMeshes() {
    const smooth = [], edges = [];
    this.materials = new Float32Array(4 * this.vertexCount);
    let first = 0;
    this.meshes = this.header.meshes.map((mesh) => {
      const triangles = this.stream(mesh.shape + "_triangles");
      const cornerNormals = mesh.has_corner_normals ? this.stream(mesh.shape + "_corner_normals") : null;
      if (mesh.smooth) for (const v of triangles) smooth.push(first + v);
      for (const v of this.stream(mesh.shape + "_edges")) edges.push(first + v);
      const colours = Float32Array.from(this.stream(mesh.shape + "_colours"), toLinear);
      for (let v = 0; v < mesh.vertices; ++v) {
        this.materials.set(colours.subarray(3 * v, 3 * v + 3), 4 * (first + v));
        this.materials[4 * (first + v) + 3] = mesh.roughness;
      }
      first += mesh.vertices;
      return { ...mesh, first: first - mesh.vertices, triangles, cornerNormals };
    });
    this.smooth = Uint32Array.from(smooth);
    this.edges = Uint32Array.from(edges);
  }

  frameNumber(frame) { return this.header.first_frame + frame; }
  step(frame) { return this.frameNumber(frame) * this.header.steps_per_frame; }
  time(frame) { return this.frameNumber(frame) / this.header.frames_per_second; }

  // Into `result`, from three integers each.
  place(quantised, begin, end, result) {
    const { origin, step } = this.header.lattice;
    for (let i = begin; i < end; ++i) result[i - begin] = origin[i % 3] + step * quantised[i];
    return result;
  }

  // x, y, z of all vertices; the array is used again for the next frame.
  positionsAt(frame) {
    const count = 3 * this.vertexCount;
    return this.place(this.quantised, frame * count, (frame + 1) * count, this.positions);
  }

  // Of the bulge, 0 to 1, at the vertices of all meshes that are drawn rounded.
  sharesAt(frame) {
    const { shares, frameCount, header } = this;
    return Float32Array.from({ length: shares.length / frameCount },
      (unused, v) => shares[v * frameCount + frame] / header.share_steps);
  }

  // The scene's own: {eye, target}.
  cameraAt(frame) {
    if (this.cameras.length === 0) return this.header.scenery;
    const numbers = [...this.cameras.subarray(6 * frame, 6 * frame + 6)];
    return { eye: numbers.slice(0, 3), target: numbers.slice(3) };
  }

  // Discs of a frame: [{position, colour, diameter}].
  marksAt(marks, frame) {
    const result = [];
    for (let i = marks.begins[frame]; i < marks.begins[frame + 1]; ++i) {
      const look = this.header.looks[marks.looks[i]];
      result.push({ position: this.place(marks.places, 3 * i, 3 * i + 3, []), ...look });
    }
    return result;
  }

  // Normals of a frame's contacts: [{from, to, colour}].
  normalsAt(frame) {
    return this.marksAt(this.contacts, frame).map(({ position, colour }, i) => {
      const n = 3 * (this.contacts.begins[frame] + i);
      const to = position.map((x, axis) => x + (this.normals[n + axis] << 24 >> 24) / 127);
      return { from: position, to, colour };
    });
  }
}

function toLinear(byte) {
  const srgb = byte / 255;
  return srgb <= 0.04045 ? srgb / 12.92 : ((srgb + 0.055) / 1.055) ** 2.4;
}
