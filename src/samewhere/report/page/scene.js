// The map in 3D: landmarks, paths, loop candidates, the camera at the time shown.
(function () {
  const element = samewhere.element;
  const kClickPixels = 10; // a click so near to a line is meant for it
  const kMaxSlowPoints = 60000; // landmarks drawn where there is no graphics card

  const sprites = new Map(); // made once, for any number of updates
  function sprite(...look) {
    const key = look.join();
    if (!sprites.has(key)) sprites.set(key, makeSprite(...look));
    return sprites.get(key);
  }
  function makeSprite(mark, colour, ground) {
    const canvas = element('canvas', { width: 64, height: 64 });
    const pen = canvas.getContext('2d');
    pen.beginPath();
    if (mark === 'dot') pen.arc(32, 32, 26, 0, 7);
    if (mark === 'circle') pen.arc(32, 32, 20, 0, 7);
    if (mark === 'diamond') { pen.moveTo(32, 6); pen.lineTo(56, 32); pen.lineTo(32, 58); pen.lineTo(8, 32); }
    if (mark === 'cross') { pen.moveTo(12, 12); pen.lineTo(52, 52); pen.moveTo(52, 12); pen.lineTo(12, 52); }
    if (mark === 'triangle') { pen.moveTo(32, 8); pen.lineTo(58, 54); pen.lineTo(6, 54); }
    if (mark !== 'cross') pen.closePath();
    pen.fillStyle = ground;
    pen.fill();
    pen.lineWidth = mark === 'cross' ? 16 : 10;
    pen.strokeStyle = colour;
    pen.stroke();
    return new THREE.CanvasTexture(canvas);
  }

  // Lines of a width in pixels.
  function wideLines(positions, options) {
    const geometry = new THREE.LineSegmentsGeometry();
    geometry.setPositions(positions);
    const material = new THREE.LineMaterial({ color: options.colour, linewidth: options.width, dashed: Boolean(options.dash), depthTest: options.depthTest !== false });
    if (options.dash) {
      material.defines.USE_DASH = '';
      [material.dashSize, material.gapSize] = options.dash;
    }
    if (options.clip) Object.assign(material, { clipping: true, clippingPlanes: options.clip });
    material.transparent = true;
    material.uniforms.opacity.value = options.opacity || 1; // the renderer does not pass it on
    const lines = new THREE.LineSegments2(geometry, material);
    if (options.dash) lines.computeLineDistances();
    lines.frustumCulled = false;
    lines.renderOrder = options.order || 1;
    return lines;
  }

  // Rows of a path that continue the row before: both have a position, and no `isBreak(row)`.
  function continuedRows(positions, num, isBreak = () => false) {
    const rows = [];
    for (let row = 1; row < num; ++row) {
      if (!Number.isNaN(positions[3 * row]) && !Number.isNaN(positions[3 * row - 3]) && !isBreak(row)) rows.push(row);
    }
    return rows;
  }
  function segments(positions, rows) {
    const values = new Float32Array(6 * rows.length);
    rows.forEach((row, i) => values.set(positions.subarray(3 * row - 3, 3 * row + 3), 6 * i));
    return values;
  }

  // Lines of one pixel, which any machine draws fast.
  function thinLines(values, options) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(values), 3));
    const common = { color: options.colour, transparent: true, opacity: options.opacity || 1, depthWrite: false, clippingPlanes: options.clip || null };
    const material = options.dash ? new THREE.LineDashedMaterial({ ...common, dashSize: options.dash[0], gapSize: options.dash[1] }) : new THREE.LineBasicMaterial(common);
    const lines = new THREE.LineSegments(geometry, material);
    if (options.dash) lines.computeLineDistances();
    lines.renderOrder = options.order || 2;
    return lines;
  }

  // Bounds of what is looked at: the path, and most landmarks near it.
  samewhere.roomOf = function (run) {
    const ofPath = run.bounds();
    const pathLength = Math.hypot(...ofPath.map(([low, high]) => high - low));
    const { positions } = run.points;
    return ofPath.map(([low, high], axis) => {
      const values = positions.filter((_, i) => i % 3 === axis).sort();
      if (!values.length) return [low, high];
      const at = (share) => values[Math.floor(share * (values.length - 1))];
      return [Math.min(low, Math.max(at(0.04), low - 2 * pathLength)), Math.max(high, Math.min(at(0.96), high + 2 * pathLength))];
    });
  };

  class Scene {
    // room: bounds of what is looked at, [lowest, highest] per axis, if they are not those of the run alone.
    constructor(run, state, canvas, { isSlow, room }) {
      this.run = run;
      this.state = state;
      this.canvas = canvas;
      this.isSlow = isSlow;
      this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !this.isSlow, preserveDrawingBuffer: true });
      this.renderer.localClippingEnabled = true;
      this.scene = new THREE.Scene();
      this.camera = new THREE.PerspectiveCamera(42, 1, 0.05, 5000);
      this.camera.up.set(0, 0, 1);
      this.controls = new THREE.OrbitControls(this.camera, canvas);
      this.controls.enableKeys = false;
      this.controls.screenSpacePanning = true;
      this.controls.maxPolarAngle = Math.PI * 0.98;
      this.controls.addEventListener('change', () => this.render());
      this.controls.addEventListener('start', () => { this.isMoved = true; });
      this.clip = [new THREE.Plane(new THREE.Vector3(0, 0, 1), 0), new THREE.Plane(new THREE.Vector3(0, 0, -1), 0)];
      this.pictureTexture = null;
      this.shown = [];
      this.useRoom(room || samewhere.roomOf(run));
      this.build();
      this.cut(state.get('heights'));
      this.watch();
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
      this.pickOnClick();
    }

    useRoom(bounds) {
      this.centre = new THREE.Vector3(...bounds.map(([low, high]) => (low + high) / 2));
      this.radius = Math.max(0.5, Math.hypot(...bounds.map(([low, high]) => (high - low) / 2)));
      this.frustumLength = Math.min(0.9, Math.max(0.12, this.radius / 16));
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

    // Views: the whole map from the side, or from above.
    look(name, isMoving = true) {
      this.isMoved = name !== 'whole';
      const elevation = name === 'above' ? Math.PI / 2 - 1e-4 : 0.9;
      const azimuth = name === 'above' ? -Math.PI / 2 : -Math.PI / 2 - 0.3;
      const towards = new THREE.Vector3(Math.cos(azimuth) * Math.cos(elevation), Math.sin(azimuth) * Math.cos(elevation), Math.sin(elevation));
      const distance = this.linked ? Math.max(...this.linked.map((scene) => scene.distanceThatFits(towards))) : this.distanceThatFits(towards);
      this.moveCamera(this.centre.clone().add(towards.multiplyScalar(distance)), this.centre.clone(), isMoving);
    }

    // The distance from the centre at which the path and nearly all landmarks are in the picture.
    distanceThatFits(towards) {
      const right = new THREE.Vector3(0, 0, 1).cross(towards).normalize();
      const up = towards.clone().cross(right);
      const tangent = Math.tan((this.camera.fov * Math.PI) / 360);
      const need = (positions, share) => {
        const distances = [];
        const step = 3 * Math.ceil(positions.length / 60000);
        for (let i = 0; i < positions.length; i += step) {
          if (Number.isNaN(positions[i])) continue;
          const v = new THREE.Vector3(positions[i], positions[i + 1], positions[i + 2]).sub(this.centre);
          distances.push(v.dot(towards) + Math.max(Math.abs(v.dot(right)) / (tangent * this.camera.aspect), Math.abs(v.dot(up)) / tangent));
        }
        distances.sort((a, b) => a - b);
        return distances.length ? distances[Math.floor(share * (distances.length - 1))] : 0;
      };
      const ofPath = need(this.run.positions, 1);
      return 1.1 * Math.max(ofPath, Math.min(need(this.run.points.positions, 0.96), 2.5 * ofPath), 0.5);
    }

    moveTarget(target) {
      const offset = this.camera.position.clone().sub(this.controls.target);
      this.controls.target.copy(target);
      this.camera.position.copy(target).add(offset);
      this.controls.update();
    }

    moveCamera(position, target, isMoving) {
      const still = matchMedia('(prefers-reduced-motion: reduce)').matches || !isMoving;
      const from = [this.camera.position.clone(), this.controls.target.clone()];
      const begin = performance.now();
      const step = () => {
        const share = still ? 1 : Math.min(1, (performance.now() - begin) / 350);
        const eased = share * share * (3 - 2 * share);
        this.camera.position.lerpVectors(from[0], position, eased);
        this.controls.target.lerpVectors(from[1], target, eased);
        this.controls.update();
        this.render();
        if (share < 1) requestAnimationFrame(step);
      };
      step();
    }

    // Scenes of one view: the camera of each moves with the others.
    static link(scenes) {
      for (const scene of scenes) {
        scene.linked = scenes;
        scene.controls.addEventListener('change', () => {
          for (const other of scenes) {
            if (other === scene) continue;
            other.camera.position.copy(scene.camera.position);
            other.camera.quaternion.copy(scene.camera.quaternion);
            other.controls.target.copy(scene.controls.target);
            other.render();
          }
        });
      }
    }

    zoom(factor) {
      const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
      this.camera.position.copy(this.controls.target).add(offset);
      this.controls.update();
    }

    size(lines) {
      if (lines && lines.material.resolution) lines.material.resolution.set(this.canvas.clientWidth || 1, this.canvas.clientHeight || 1);
    }

    resize() {
      const { clientWidth, clientHeight } = this.canvas.parentElement;
      if (!clientWidth || !clientHeight) return;
      this.renderer.setPixelRatio(Math.min(2, devicePixelRatio || 1));
      this.renderer.setSize(clientWidth, clientHeight, false);
      this.camera.aspect = clientWidth / clientHeight;
      this.camera.updateProjectionMatrix();
      this.scene.traverse((object) => { if (object instanceof THREE.LineSegments2) this.size(object); });
      this.render();
    }

    render() {
      if (this.isDue) return;
      this.isDue = true;
      requestAnimationFrame(() => { this.isDue = false; this.renderNow(); });
    }
    renderNow() { this.renderer.render(this.scene, this.camera); }

    // Where a point of the map is on the canvas, in CSS pixels; null: behind the camera.
    onCanvas(point) {
      const v = new THREE.Vector3(...point).project(this.camera);
      return v.z > 1 ? null : [((v.x + 1) / 2) * this.canvas.clientWidth, ((1 - v.y) / 2) * this.canvas.clientHeight];
    }

    // The visible candidate whose line passes nearest to a pixel.
    candidateAt(x, y) {
      return samewhere.nearestLine(this.shown, (point) => this.onCanvas(point), x, y, kClickPixels);
    }

    pickOnClick() {
      samewhere.onClickWithoutDrag(this.canvas, (x, y) => {
        const candidate = this.candidateAt(x, y);
        if (candidate) this.state.set('selected', candidate);
      });
      this.canvas.addEventListener('mousemove', (event) => {
        if (event.buttons) return;
        const box = this.canvas.getBoundingClientRect();
        this.canvas.style.cursor = this.candidateAt(event.clientX - box.left, event.clientY - box.top) ? 'pointer' : 'grab';
      });
    }
  }

  // Of lines to choose from, the one with least distance to (x, y) under a limit; accepted loops win ties.
  samewhere.nearestLine = function (candidates, onCanvas, x, y, limit) {
    const order = { false: 0, accepted: 0, withdrawn: 1, ambiguous: 2, rejected: 3 };
    let best = null;
    let bestCost = limit;
    for (const candidate of candidates) {
      const a = onCanvas(candidate.ends[0]);
      const b = onCanvas(candidate.ends[1]);
      if (!a || !b) continue;
      const length2 = (b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2;
      const share = length2 ? Math.min(1, Math.max(0, ((x - a[0]) * (b[0] - a[0]) + (y - a[1]) * (b[1] - a[1])) / length2)) : 0;
      const cost = Math.hypot(a[0] + share * (b[0] - a[0]) - x, a[1] + share * (b[1] - a[1]) - y) + order[candidate.kind] - 3;
      if (cost < bestCost) { best = candidate; bestCost = cost; }
    }
    return best;
  };

  samewhere.onClickWithoutDrag = function (canvas, click) {
    let begin = null;
    canvas.addEventListener('pointerdown', (event) => { begin = [event.clientX, event.clientY]; });
    canvas.addEventListener('pointerup', (event) => {
      if (!begin || Math.hypot(event.clientX - begin[0], event.clientY - begin[1]) > 4 || event.button !== 0) return;
      const box = canvas.getBoundingClientRect();
      click(event.clientX - box.left, event.clientY - box.top);
    });
  };

  // Pairs of half axes of the 95 % ellipsoid of a covariance (xx, xy, xz, yy, yz, zz, of the world).
  samewhere.ellipseAxes = function (m, axes) {
    const kChi = Math.sqrt(7.815); // 95 % of chi-square with 3 degrees of freedom
    const { values, vectors } = samewhere.eigen([[m[0], m[1], m[2]], [m[1], m[3], m[4]], [m[2], m[4], m[5]]]);
    const half = values.map((value, i) => axes.direction(vectors.map((row) => row[i])).map((v) => v * kChi * Math.sqrt(Math.max(0, value))));
    return [[half[0], half[1]], [half[1], half[2]], [half[0], half[2]]];
  };
  // Of a symmetric 3 x 3 matrix, by Jacobi rotations; vectors are the columns.
  samewhere.eigen = function (matrix) {
    const a = matrix.map((row) => [...row]);
    const v = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    for (let sweep = 0; sweep < 20; ++sweep) {
      for (const [p, q] of [[0, 1], [0, 2], [1, 2]]) {
        if (Math.abs(a[p][q]) < 1e-300) continue;
        const theta = 0.5 * Math.atan2(2 * a[p][q], a[q][q] - a[p][p]);
        const c = Math.cos(theta);
        const s = Math.sin(theta);
        for (let k = 0; k < 3; ++k) [a[k][p], a[k][q]] = [c * a[k][p] - s * a[k][q], s * a[k][p] + c * a[k][q]];
        for (let k = 0; k < 3; ++k) [a[p][k], a[q][k]] = [c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]];
        for (let k = 0; k < 3; ++k) [v[k][p], v[k][q]] = [c * v[k][p] - s * v[k][q], s * v[k][p] + c * v[k][q]];
      }
    }
    return { values: [a[0][0], a[1][1], a[2][2]], vectors: v };
  };

  // null: there is no WebGL. Else whether the processor draws, which takes long.
  samewhere.probeWebGL = function () {
    const context = document.createElement('canvas').getContext('webgl');
    if (!context) return null;
    const names = context.getExtension('WEBGL_debug_renderer_info');
    const renderer = names ? context.getParameter(names.UNMASKED_RENDERER_WEBGL) : '';
    return { isSlow: /swiftshader|llvmpipe|softpipe|software/i.test(renderer) };
  };
  samewhere.Scene = Scene;
})();
