// The map from above on a 2D canvas, where the browser has no WebGL. Same interface as Scene.
(function () {
  const kMaxPoints = 60000;
  const kMaxPieces = 600;

  class Plan {
    constructor(run, state, canvas) {
      this.run = run;
      this.state = state;
      this.canvas = canvas;
      this.pen = canvas.getContext('2d');
      this.shown = [];
      this.fit();
      for (const name of ['theme', 'colourBy', 'selected', 'row', 'heights', 'layers']) state.watch(name, () => this.render());
      state.watch('candidates', (candidates) => {
        this.shown = candidates.filter((candidate) => candidate.hasLine);
        this.render();
      });
      state.onChange('changed', () => { if (!this.scale) this.fit(); this.render(); });
      this.listen();
      new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
      this.resize();
    }

    fit() {
      const [x, y] = this.run.bounds();
      this.centre = [(x[0] + x[1]) / 2, (y[0] + y[1]) / 2];
      this.extent = [Math.max(1, x[1] - x[0]), Math.max(1, y[1] - y[0])];
      this.scale = null;
    }
    look() { this.fit(); this.render(); }
    zoom(factor) { this.scale = this.pixelsPerUnit() / factor; this.render(); }
    pixelsPerUnit() {
      return this.scale || 0.8 * Math.min(this.canvas.clientWidth / this.extent[0], this.canvas.clientHeight / this.extent[1]);
    }
    onCanvas(point) {
      const scale = this.pixelsPerUnit();
      return [this.canvas.clientWidth / 2 + scale * (point[0] - this.centre[0]), this.canvas.clientHeight / 2 - scale * (point[1] - this.centre[1])];
    }
    candidateAt(x, y) { return samewhere.nearestLine(this.shown, (point) => this.onCanvas(point), x, y, 10); }

    listen() {
      samewhere.onClickWithoutDrag(this.canvas, (x, y) => {
        const candidate = this.candidateAt(x, y);
        if (candidate) this.state.set('selected', candidate);
      });
      this.canvas.addEventListener('wheel', (event) => {
        event.preventDefault();
        this.zoom(event.deltaY > 0 ? 1.15 : 1 / 1.15);
      }, { passive: false });
      this.canvas.addEventListener('pointermove', (event) => {
        if (!event.buttons) return;
        const scale = this.scale = this.pixelsPerUnit();
        this.centre = [this.centre[0] - event.movementX / scale, this.centre[1] + event.movementY / scale];
        this.render();
      });
    }

    resize() {
      const { clientWidth, clientHeight } = this.canvas.parentElement;
      const ratio = Math.min(2, devicePixelRatio || 1);
      this.canvas.width = Math.round(clientWidth * ratio);
      this.canvas.height = Math.round(clientHeight * ratio);
      this.ratio = ratio;
      this.renderNow();
    }
    render() {
      if (this.isDue) return;
      this.isDue = true;
      requestAnimationFrame(() => { this.isDue = false; this.renderNow(); });
    }
    renderNow() {
      const { pen } = this;
      pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
      pen.fillStyle = samewhere.css('scene');
      pen.fillRect(0, 0, this.canvas.clientWidth, this.canvas.clientHeight);
      const layers = this.state.get('layers');
      if (layers.points !== false) this.drawPoints();
      if (layers.odometry !== false) this.drawPath(this.run.odometry, 'odometry', []);
      if (layers.truth !== false) this.drawPath(this.run.truth, 'truth', [6, 4]);
      this.drawFrames();
      this.drawCandidates();
      this.drawCamera();
    }
    drawPoints() {
      const { positions, colours } = this.run.points;
      const step = Math.ceil(positions.length / 3 / kMaxPoints);
      const heights = this.state.get('heights') || [-Infinity, Infinity];
      for (let i = 0; i < positions.length; i += 3 * step) {
        if (positions[i + 2] < heights[0] || positions[i + 2] > heights[1]) continue;
        const [x, y] = this.onCanvas([positions[i], positions[i + 1]]);
        this.pen.fillStyle = `rgb(${colours[i]} ${colours[i + 1]} ${colours[i + 2]})`;
        this.pen.fillRect(x, y, 1.5, 1.5);
      }
    }
    drawPath(path, name, dash) {
      this.pen.beginPath();
      this.pen.setLineDash(dash);
      for (let i = 0; i < path.times.length; ++i) {
        const [x, y] = this.onCanvas([path.positions[3 * i], path.positions[3 * i + 1]]);
        if (i > 0 && path.times[i] - path.times[i - 1] < 1) this.pen.lineTo(x, y); else this.pen.moveTo(x, y);
      }
      this.pen.strokeStyle = samewhere.css(name);
      this.pen.lineWidth = 1.5;
      this.pen.stroke();
      this.pen.setLineDash([]);
    }
    // In at most kMaxPieces pieces, each of one colour.
    drawFrames() {
      const colouring = samewhere.pathColouring(this.run, this.state.get('colourBy'));
      const { pen } = this;
      pen.lineWidth = 4;
      pen.lineCap = 'round';
      const step = Math.ceil(this.run.num / kMaxPieces);
      for (let begin = 0; begin < this.run.num - 1; begin += step) {
        pen.beginPath();
        let isOpen = false;
        for (let row = begin; row <= Math.min(this.run.num - 1, begin + step); ++row) {
          const at = this.run.position(row);
          if (at && isOpen) pen.lineTo(...this.onCanvas(at));
          if (at && !isOpen) pen.moveTo(...this.onCanvas(at));
          isOpen = at !== null;
        }
        pen.strokeStyle = `rgb(${colouring.colour(begin).map((value) => Math.round(255 * value)).join(' ')})`;
        pen.stroke();
      }
    }
    drawCandidates() {
      for (const kind of [...samewhere.kindNames].reverse()) {
        const style = samewhere.lineStyles[kind];
        for (const candidate of this.shown) {
          if (candidate.kind === kind) this.drawLine(candidate, samewhere.css(kind), style.width, style.dash || [], style.opacity);
        }
      }
      const selected = this.state.get('selected');
      if (selected && selected.hasLine) this.drawLine(selected, samewhere.css('selected'), 5, [], 1);
    }
    drawLine(candidate, colour, width, dash, opacity) {
      const { pen } = this;
      pen.globalAlpha = opacity;
      pen.setLineDash(dash);
      pen.strokeStyle = colour;
      pen.lineWidth = width;
      pen.beginPath();
      pen.moveTo(...this.onCanvas(candidate.ends[0]));
      pen.lineTo(...this.onCanvas(candidate.ends[1]));
      pen.stroke();
      pen.setLineDash([]);
      pen.globalAlpha = 1;
      if (candidate.kind === 'rejected') return;
      const [x, y] = this.onCanvas([0, 1, 2].map((k) => (candidate.ends[0][k] + candidate.ends[1][k]) / 2));
      pen.beginPath();
      pen.arc(x, y, 6, 0, 7);
      pen.fillStyle = samewhere.css('scene');
      pen.lineWidth = 3;
      pen.fill();
      pen.stroke();
    }
    drawCamera() {
      const at = this.run.position(this.state.get('row'));
      if (!at) return;
      const [x, y] = this.onCanvas(at);
      const ahead = this.run.directions(this.state.get('row'))[2];
      const angle = Math.atan2(-ahead[1], ahead[0]);
      const { pen } = this;
      pen.beginPath();
      pen.moveTo(x, y);
      pen.arc(x, y, 26, angle - 0.5, angle + 0.5);
      pen.closePath();
      pen.strokeStyle = samewhere.css('camera');
      pen.lineWidth = 2.5;
      pen.stroke();
    }
  }
  samewhere.Plan = Plan;
})();
