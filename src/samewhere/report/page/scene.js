// The map in 3D: landmarks, paths, loop candidates, the camera at the time shown.
(function () {
  const { sprite, wideLines, continuedRows, segments, thinLines } = samewhere.drawing;
  const kMaxSlowPoints = 60000; // landmarks drawn where there is no graphics card

  class Scene extends samewhere.Viewpoint {
    // room: bounds of what is looked at, [lowest, highest] per axis, if they are not those of the run alone.
    constructor(run, state, canvas, { isSlow, room }) {
      super(canvas, isSlow);
      this.run = run;
      this.state = state;
      this.clip = [new THREE.Plane(new THREE.Vector3(0, 0, 1), 0), new THREE.Plane(new THREE.Vector3(0, 0, -1), 0)];
      this.pictureTexture = null;
      this.shown = [];
      this.useRoom(room || samewhere.roomOf(run));
      this.build();
      this.cut(state.get('heights'));
      this.watch();
      this.pickOnClick((candidate) => state.set('selected', candidate));
      this.resize();
      this.look('whole', false);
      new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    }

    watch() {
      this.state.onChange('theme', () => this.build());
      this.state.onChange('colourBy', () => this.buildPath());
      this.state.onChange('candidates', (candidates) => this.showCandidates(candidates));
      this.state.onChange('selected', () => this.showSelected());
      this.state.onChange('row', () => { this.showCamera(); this.showGrowth(); });
      this.state.onChange('isGrowing', () => this.showGrowth());
      this.state.onChange('heights', (heights) => this.cut(heights));
      this.state.onChange('layers', () => this.showLayers());
      this.state.onChange('changed', (changed) => this.grow(changed));
    }

    replace(name, object) {
      if (this[name]) {
        this.scene.remove(this[name]);
        if (this[name].geometry) this[name].geometry.dispose();
        if (this[name].material) this[name].material.dispose(); // textures are shared
      }
      this[name] = object;
      if (object) this.scene.add(object);
    }

    // Everything whose colours depend on the theme.
    build() {
      this.scene.background = new THREE.Color(samewhere.css('scene'));
      this.buildPoints();
      if (this.run.dense) this.buildPoints('dense');
      this.buildGround();
      this.buildPath();
      this.buildOtherPaths();
      this.buildEllipses();
      this.showCandidates(this.state.get('candidates'));
      this.showCamera();
      this.showLayers();
      this.render();
    }

    // The run has gone on.
    grow(changed) {
      if (changed.points || changed.all) {
        this.useRoom(samewhere.roomOf(this.run));
        if (Math.abs(this.radius / this.radiusOfGround - 1) > 0.05) {
          this.buildGround();
          if (!this.isMoved && !this.state.get('isFollowing')) this.look('whole', false);
        }
      }
      if (changed.points) this.buildPoints();
      this.buildPath();
      if (changed.candidates || changed.all) this.showCandidates(this.state.get('candidates'));
      this.showCamera();
      this.showLayers();
    }

    buildPoints(name = 'points') {
      const { positions, colours } = this.run[name];
      const geometry = new THREE.BufferGeometry();
      if (this.isSlow && positions.length > 3 * kMaxSlowPoints) {
        const step = Math.ceil(positions.length / 3 / kMaxSlowPoints);
        geometry.setIndex(Array.from({ length: Math.floor(positions.length / 3 / step) }, (_, i) => i * step));
        this.note = `Drawn without a graphics card: 1 of ${step} ${name === 'points' ? 'landmarks' : 'points'}. `;
      }
      geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
      geometry.setAttribute('color', new THREE.BufferAttribute(colours, 3, true));
      const shade = Number(samewhere.css('point-shade')) || 1;
      const material = new THREE.PointsMaterial({ size: 2 * this.renderer.getPixelRatio(), sizeAttenuation: false, vertexColors: THREE.VertexColors, clippingPlanes: this.clip });
      material.color.setRGB(shade, shade, shade);
      this.replace(name, new THREE.Points(geometry, material));
    }

    buildGround() {
      const step = 10 ** Math.floor(Math.log10(this.radius / 2 || 1));
      const num = Math.min(60, 2 * Math.ceil((1.4 * this.radius) / step));
      const grid = new THREE.GridHelper(num * step, num, samewhere.css('grid'), samewhere.css('grid'));
      grid.rotation.x = Math.PI / 2;
      const [low] = this.run.bounds()[2];
      grid.position.set(Math.round(this.centre.x / step) * step, Math.round(this.centre.y / step) * step, low - 0.05 * this.radius);
      grid.material.transparent = true;
      grid.material.opacity = 0.5;
      grid.material.depthWrite = false;
      this.gridStep = step;
      this.radiusOfGround = this.radius;
      this.replace('ground', grid);
    }

    // The path as dots so near to each other that they are a line.
    buildPath() {
      const { positions } = this.run;
      const colouring = samewhere.pathColouring(this.run, this.state.get('colourBy'));
      const spacing = this.radius / 250;
      const dots = [];
      const colours = [];
      this.dotsUntilRow = new Uint32Array(this.run.num + 1); // dots of the path up to each row
      for (const row of continuedRows(positions, this.run.num)) {
        const a = this.run.position(row - 1);
        const b = this.run.position(row);
        const num = Math.min(20, Math.ceil(Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]) / spacing));
        for (let i = 0; i < num; ++i) {
          dots.push(...[0, 1, 2].map((k) => a[k] + ((b[k] - a[k]) * i) / num));
          colours.push(...colouring.colour(i * 2 < num ? row - 1 : row));
        }
        this.dotsUntilRow[row] = dots.length / 3;
      }
      for (let row = 1; row <= this.run.num; ++row) this.dotsUntilRow[row] = Math.max(this.dotsUntilRow[row], this.dotsUntilRow[row - 1]);
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(dots), 3));
      geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(colours), 3));
      const material = new THREE.PointsMaterial({ size: 5 * this.renderer.getPixelRatio(), sizeAttenuation: false, vertexColors: THREE.VertexColors, map: sprite('dot', '#ffffff', '#ffffff'), alphaTest: 0.5, clippingPlanes: this.clip });
      const path = dots.length ? new THREE.Points(geometry, material) : null;
      if (path) path.renderOrder = 3;
      this.replace('path', path);
      this.showGrowth();
    }

    // While the run is played, path and candidates up to the time shown; else all.
    showGrowth() {
      const isGrowing = this.state.get('isGrowing');
      if (this.path) this.path.geometry.setDrawRange(0, isGrowing ? this.dotsUntilRow[this.state.get('row')] : Infinity);
      const numShown = this.candidatesNow(this.state.get('candidates')).length;
      if (numShown !== this.shown.length) this.showCandidates(this.state.get('candidates'));
      this.render();
    }
    candidatesNow(candidates) {
      const last = this.state.get('isGrowing') ? this.state.get('row') : Infinity;
      return candidates.filter((candidate) => candidate.hasLine && candidate.queryRow <= last);
    }

    buildOtherPaths() {
      for (const name of ['odometry', 'truth']) {
        const path = this.run[name];
        const rows = continuedRows(path.positions, path.times.length, (row) => path.times[row] - path.times[row - 1] > 1);
        const dash = name === 'truth' ? [this.radius / 60, this.radius / 90] : null;
        this.replace(name, rows.length ? thinLines(segments(path.positions, rows), { colour: samewhere.css(name), dash, clip: this.clip }) : null);
      }
    }

    // The ellipsoid of 95 % of each covariance, as three ellipses in its main planes.
    buildEllipses() {
      const values = [];
      for (const { row, matrix } of this.run.covariances) {
        const at = this.run.position(row);
        samewhere.ellipseAxes(matrix, this.run.axes).forEach(([a, b]) => {
          for (let i = 0; i < 32; ++i) {
            for (const angle of [i, i + 1].map((k) => (2 * Math.PI * k) / 32)) {
              for (let k = 0; k < 3; ++k) values.push(at[k] + Math.cos(angle) * a[k] + Math.sin(angle) * b[k]);
            }
          }
        });
      }
      this.replace('ellipses', values.length ? thinLines(values, { colour: samewhere.css('ellipse'), opacity: 0.7, clip: this.clip }) : null);
    }

    showCandidates(candidates) {
      this.shown = this.candidatesNow(candidates);
      const limit = this.run.limits.find((entry) => entry.score === 'num_inliers');
      // rejected for too few inliers: many, and of little interest
      const isWeak = (candidate) => candidate.kind === 'rejected' && limit && (candidate.scores.num_inliers || 0) < limit.value;
      for (const kind of samewhere.kindNames) {
        const style = samewhere.lineStyles[kind];
        const ofKind = this.shown.filter((candidate) => candidate.kind === kind);
        this.drawLines(`lines-${kind}`, ofKind.filter((candidate) => !isWeak(candidate)), kind, style);
        this.drawLines(`weak-${kind}`, ofKind.filter(isWeak), kind, { ...style, width: 1, opacity: 0.13 });
        this.replace(`marks-${kind}`, style.mark && ofKind.length ? this.marks(ofKind, style.mark, samewhere.css(kind), 15) : null);
      }
      this.showSelected();
    }
    drawLines(name, candidates, kind, style) {
      const values = candidates.flatMap(({ ends }) => [...ends[0], ...ends[1]]);
      const dash = style.dash && style.dash.map((pixels) => (pixels * this.radius) / 400);
      const options = { ...style, colour: new THREE.Color(samewhere.css(kind)), dash, depthTest: kind !== 'accepted' && kind !== 'false', order: 4, clip: this.clip };
      this.replace(name, values.length ? (kind === 'rejected' ? thinLines : wideLines)(values, options) : null);
      this.size(this[name]);
    }

    marks(candidates, mark, colour, pixels) {
      const geometry = new THREE.BufferGeometry();
      const middles = candidates.flatMap(({ ends }) => [0, 1, 2].map((k) => (ends[0][k] + ends[1][k]) / 2));
      geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(middles), 3));
      const material = new THREE.PointsMaterial({ map: sprite(mark, colour, samewhere.css('scene')), size: pixels * this.renderer.getPixelRatio(), sizeAttenuation: false, transparent: true, depthTest: false, clippingPlanes: this.clip });
      const marks = new THREE.Points(geometry, material);
      marks.renderOrder = 6;
      return marks;
    }

    showSelected() {
      const candidate = this.state.get('selected');
      const line = candidate && candidate.hasLine ? [...candidate.ends[0], ...candidate.ends[1]] : null;
      const colour = samewhere.css('selected');
      this.replace('selectedLine', line ? wideLines(line, { colour: new THREE.Color(colour), width: 5, depthTest: false, order: 7 }) : null);
      this.size(this.selectedLine);
      this.replace('selectedEnds', line ? this.marks([{ ends: [candidate.ends[0], candidate.ends[0]] }, { ends: [candidate.ends[1], candidate.ends[1]] }], 'circle', colour, 17) : null);
      this.render();
    }

    // The camera at the time shown: its frustum, with the picture nearest in time.
    showCamera() {
      const row = this.state.get('row');
      const at = this.run.position(row);
      this.replace('frustum', null);
      this.replace('picture', null);
      if (at) {
        const [right, down, ahead] = this.run.directions(row);
        const length = this.frustumLength;
        const corner = (x, y) => [0, 1, 2].map((k) => at[k] + length * (ahead[k] + 0.55 * x * right[k] + 0.41 * y * down[k]));
        const corners = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)];
        const values = corners.flatMap((a, i) => [...at, ...a, ...a, ...corners[(i + 1) % 4]]);
        this.replace('frustum', wideLines(values, { colour: new THREE.Color(samewhere.css('camera')), width: 2.5, order: 5 }));
        this.size(this.frustum);
        this.showPicture(corners, row);
        if (this.state.get('isFollowing')) this.moveTarget(new THREE.Vector3(...at));
      }
      this.render();
    }

    showPicture(corners, row) {
      const pictureRow = this.run.nearestPictureRow(row);
      if (pictureRow < 0) return;
      const source = this.run.picture(this.run.indices[pictureRow]);
      if (this.pictureSource !== source) {
        this.pictureSource = source;
        const image = new Image();
        image.onload = () => {
          if (this.pictureSource !== source) return;
          if (this.pictureTexture) this.pictureTexture.dispose();
          this.pictureTexture = new THREE.Texture(image);
          this.pictureTexture.minFilter = THREE.LinearFilter;
          this.pictureTexture.needsUpdate = true;
          if (this.picture) this.picture.material.map = this.pictureTexture;
          if (this.picture) this.picture.material.needsUpdate = true;
          this.render();
        };
        image.src = source;
      }
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array([0, 3, 2, 0, 2, 1].flatMap((i) => corners[i])), 3));
      geometry.setAttribute('uv', new THREE.BufferAttribute(new Float32Array([0, 1, 0, 0, 1, 0, 0, 1, 1, 0, 1, 1]), 2));
      this.replace('picture', new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ map: this.pictureTexture, side: THREE.DoubleSide, transparent: true, opacity: 0.92 })));
    }

    showLayers() {
      const layers = this.state.get('layers');
      for (const name of ['points', 'dense', 'odometry', 'truth', 'ellipses', 'ground']) {
        if (this[name]) this[name].visible = layers[name] !== false;
      }
      this.render();
    }

    cut(heights) {
      if (!heights) return;
      this.clip[0].constant = -heights[0];
      this.clip[1].constant = heights[1];
      this.render();
    }
  }

  samewhere.Scene = Scene;
})();
