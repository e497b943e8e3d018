// The data of a run, from the blocks of the page (README.md). Positions are turned so that x is
// right and y up in the view from above, and z is the height; the first pose is at the origin.
(function () {
  function unpacked(array) {
    if (ArrayBuffer.isView(array)) return array;
    const text = atob(array.base64);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    const types = { Float32Array, Uint8Array, Uint16Array, Int16Array, Uint32Array };
    const stored = new types[array.type](bytes.buffer);
    if (!array.step) return stored;
    const values = new Float64Array(stored.length);
    for (let i = 0; i < stored.length; ++i) {
      const column = i % array.columns;
      values[i] = (array.low ? array.low[column] : 0) + stored[i] * (array.step[column] || array.step[0]);
    }
    return values;
  }

  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

  // From world axes to those of the page, and back to nothing: only positions and directions.
  class Axes {
    constructor(upright, origin) {
      this.rows = [upright.right, cross(upright.up, upright.right), upright.up];
      this.origin = origin;
    }
    direction(v) { return this.rows.map((row) => dot(row, v)); }
    positions(values) {
      const turned = new Float32Array(values.length);
      for (let i = 0; i < values.length; i += 3) {
        const v = [values[i] - this.origin[0], values[i + 1] - this.origin[1], values[i + 2] - this.origin[2]];
        for (let k = 0; k < 3; ++k) turned[i + k] = dot(this.rows[k], v);
      }
      return turned;
    }
  }

  // The columns of the rotation matrix of a unit quaternion.
  function columns(x, y, z, w) {
    return [[1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
            [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
            [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]];
  }

  function firstPosition(positions) {
    for (let i = 0; i < positions.length; i += 3) {
      if (!Number.isNaN(positions[i])) return [positions[i], positions[i + 1], positions[i + 2]];
    }
    return [0, 0, 0];
  }

  const kinds = { LOOP: 'accepted', AMBIGUOUS: 'ambiguous', NOT: 'rejected' };
  function kindOf(candidate) {
    if (candidate.is_false) return 'false';
    return candidate.stage === 'withdrawn' && candidate.verdict === 'NOT' ? 'withdrawn' : kinds[candidate.verdict];
  }

  // Position of a path at a time, between its stamps; null outside of them.
  function positionAt(path, time) {
    const { times, positions } = path;
    if (!times.length || time < times[0] - 1e-3 || time > times[times.length - 1] + 1e-3) return null;
    let low = 0;
    let high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= time) low = middle; else high = middle;
    }
    const span = times[high] - times[low];
    if (span > 1) return null;
    const share = span > 0 ? Math.min(1, Math.max(0, (time - times[low]) / span)) : 0;
    return [0, 1, 2].map((k) => (1 - share) * positions[3 * low + k] + share * positions[3 * high + k]);
  }

  const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

  class Run {
    constructor(data, pictures, durations) {
      Object.assign(this, data);
      const frames = data.frames;
      const worldPositions = unpacked(frames.positions);
      this.axes = new Axes(data.upright, firstPosition(worldPositions));
      this.num = frames.num;
      this.indices = unpacked(frames.indices);
      this.times = unpacked(frames.stamps_s);
      this.positions = this.axes.positions(worldPositions);
      this.rotations = unpacked(frames.rotations);
      this.statuses = unpacked(frames.statuses);
      this.inliers = unpacked(frames.inliers);
      this.names = frames.names;
      this.odometry = this.path(data.odometry);
      this.truth = this.path(data.truth);
      this.points = { positions: this.axes.positions(unpacked(data.points.positions)), colours: unpacked(data.points.colours), numInMap: data.points.num_in_map };
      this.dense = data.dense ? { positions: this.axes.positions(unpacked(data.dense.positions)), colours: unpacked(data.dense.colours) } : null;
      this.durations_ms = unpacked(durations.frames_ms);
      this.stages = durations.stages;
      this.memory = durations.memory ? { frames: unpacked(durations.memory.frames), mib: unpacked(durations.memory.mib) } : { frames: [], mib: [] };
      this.unit = data.is_scale_unknown ? 'map units' : 'm';
      this.compareWithPaths();
      this.rowOfIndex = new Map();
      this.indices.forEach((index, row) => this.rowOfIndex.set(index, row));
      this.readPictures(pictures);
      this.candidates.forEach((candidate) => this.complete(candidate));
      this.covariances = data.covariances ? this.readCovariances(data.covariances) : [];
    }

    path(packed) {
      return { times: unpacked(packed.stamps_s), positions: this.axes.positions(unpacked(packed.positions)) };
    }

    // Errors of each frame against the truth, and the drift that loop closing took out.
    compareWithPaths() {
      this.errors = new Float32Array(this.num).fill(NaN);
      this.odometryErrors = new Float32Array(this.num).fill(NaN);
      this.corrections = new Float32Array(this.num).fill(NaN);
      for (let row = 0; row < this.num; ++row) {
        const here = this.position(row);
        const odometry = positionAt(this.odometry, this.times[row]);
        const truth = positionAt(this.truth, this.times[row]);
        if (here && truth) this.errors[row] = distance(here, truth);
        if (odometry && truth) this.odometryErrors[row] = distance(odometry, truth);
        if (here && odometry) this.corrections[row] = distance(here, odometry);
      }
      this.hasTruth = this.errors.some((value) => !Number.isNaN(value));
      this.hasOdometry = this.corrections.some((value) => !Number.isNaN(value));
    }

    position(row) {
      const x = this.positions[3 * row];
      return row < 0 || row >= this.num || Number.isNaN(x) ? null : [x, this.positions[3 * row + 1], this.positions[3 * row + 2]];
    }
    // Of the camera: right, down and ahead, in the axes of the page.
    directions(row) {
      const q = this.rotations.subarray(4 * row, 4 * row + 4);
      const length = Math.hypot(q[0], q[1], q[2], q[3]) || 1;
      return columns(q[0] / length, q[1] / length, q[2] / length, q[3] / length).map((axis) => this.axes.direction(axis));
    }
    statusName(row) { return this.status_names[this.statuses[row]]; }

    readPictures(pictures) {
      this.pictures = new Map(pictures.map((picture) => [`${picture.session}:${picture.frame}`, picture.jpeg_base64]));
      const session = this.frames.session || 0;
      this.session = session;
      this.pictureRows = pictures.filter((picture) => picture.session === session && this.rowOfIndex.has(picture.frame))
        .map((picture) => this.rowOfIndex.get(picture.frame)).sort((a, b) => a - b);
    }
    picture(index, session = this.session) {
      const jpeg = this.pictures.get(`${session}:${index}`);
      return jpeg ? `data:image/jpeg;base64,${jpeg}` : null;
    }
    // The row with a picture that is nearest in time; -1: there is none.
    nearestPictureRow(row) {
      let best = -1;
      for (const other of this.pictureRows) {
        if (best < 0 || Math.abs(this.times[other] - this.times[row]) < Math.abs(this.times[best] - this.times[row])) best = other;
      }
      return best;
    }

    complete(candidate) {
      const isForeign = candidate.match_session !== undefined && candidate.match_session !== candidate.query_session;
      candidate.kind = kindOf(candidate);
      candidate.queryRow = this.rowOfIndex.has(candidate.query) ? this.rowOfIndex.get(candidate.query) : -1;
      candidate.matchRow = !isForeign && this.rowOfIndex.has(candidate.match) ? this.rowOfIndex.get(candidate.match) : -1;
      candidate.matchName = isForeign ? `${candidate.match} of session ${candidate.match_session}` : `${candidate.match}`;
      candidate.ends = [this.position(candidate.queryRow), this.position(candidate.matchRow)];
      candidate.hasLine = candidate.ends[0] !== null && candidate.ends[1] !== null;
      candidate.queryPicture = this.picture(candidate.query);
      candidate.matchPicture = this.picture(candidate.match, isForeign ? candidate.match_session : this.session);
      candidate.trueDistance = this.trueDistance(candidate);
    }
    // Between the two views by the ground truth; null where it is not known.
    trueDistance(candidate) {
      if (candidate.queryRow < 0 || candidate.matchRow < 0) return null;
      const query = positionAt(this.truth, this.times[candidate.queryRow]);
      const match = positionAt(this.truth, this.times[candidate.matchRow]);
      return query && match ? distance(query, match) : null;
    }

    readCovariances(packed) {
      const rows = unpacked(packed.frames);
      const values = unpacked(packed.matrices);
      return Array.from(rows, (index, i) => ({ row: this.rowOfIndex.get(index), matrix: values.subarray(6 * i, 6 * i + 6) }))
        .filter((entry) => entry.row !== undefined && this.position(entry.row));
    }

    // Of the positions of the frames: [lowest, highest] per axis.
    bounds() {
      const bounds = [[Infinity, -Infinity], [Infinity, -Infinity], [Infinity, -Infinity]];
      const widen = (positions) => {
        for (let i = 0; i < positions.length; ++i) {
          if (Number.isNaN(positions[i])) continue;
          const axis = bounds[i % 3];
          axis[0] = Math.min(axis[0], positions[i]);
          axis[1] = Math.max(axis[1], positions[i]);
        }
      };
      widen(this.positions);
      if (!Number.isFinite(bounds[0][0])) return [[-1, 1], [-1, 1], [-1, 1]];
      return bounds;
    }
  }

  // Decoded matches of a candidate: shares of the images, and which are inliers.
  samewhere.matchesOf = function (candidate) {
    if (!candidate.matches) return null;
    return { shares: unpacked(candidate.matches.shares), areInliers: unpacked(candidate.matches.are_inliers) };
  };
  samewhere.Run = Run;
  samewhere.unpacked = unpacked;
})();
