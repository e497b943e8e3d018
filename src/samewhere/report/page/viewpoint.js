// Where a scene is seen from: renderer, camera and controls, the views of buttons and keys, clicks on lines.
(function () {
  const kClickPixels = 10; // a click so near to a line is meant for it

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

  // Of a scene of a run: `run` is what is looked at, `shown` are the candidates that can be clicked.
  class Viewpoint {
    constructor(canvas, isSlow) {
      this.canvas = canvas;
      this.isSlow = isSlow;
      this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !isSlow, preserveDrawingBuffer: true });
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
    }

    useRoom(bounds) {
      this.centre = new THREE.Vector3(...bounds.map(([low, high]) => (low + high) / 2));
      this.radius = Math.max(0.5, Math.hypot(...bounds.map(([low, high]) => (high - low) / 2)));
      this.frustumLength = Math.min(0.9, Math.max(0.12, this.radius / 16));
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

    // select: called with the candidate whose line is clicked.
    pickOnClick(select) {
      samewhere.onClickWithoutDrag(this.canvas, (x, y) => {
        const candidate = this.candidateAt(x, y);
        if (candidate) select(candidate);
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

  // null: there is no WebGL. Else whether the processor draws, which takes long.
  samewhere.probeWebGL = function () {
    const context = document.createElement('canvas').getContext('webgl');
    if (!context) return null;
    const names = context.getExtension('WEBGL_debug_renderer_info');
    const renderer = names ? context.getParameter(names.UNMASKED_RENDERER_WEBGL) : '';
    return { isSlow: /swiftshader|llvmpipe|softpipe|software/i.test(renderer) };
  };
  samewhere.Viewpoint = Viewpoint;
})();
