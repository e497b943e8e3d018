// The time shown: slider, playback, the status of each frame, the picture nearest in time.
(function () {
  const { element, byId, number } = samewhere;

  class Timeline {
    constructor(run, state) {
      this.run = run;
      this.state = state;
      this.slider = byId('time-slider');
      this.slider.max = Math.max(0, run.num - 1);
      this.slider.addEventListener('input', () => state.set('row', Number(this.slider.value)));
      byId('play').addEventListener('click', () => this.togglePlay());
      state.watch('row', (row) => this.show(row));
      state.watch('theme', () => this.drawStrip());
      state.onChange('changed', () => {
        this.slider.max = Math.max(0, run.num - 1);
        this.drawStrip();
      });
      new ResizeObserver(() => this.drawStrip()).observe(byId('status-strip'));
    }

    show(row) {
      const { run } = this;
      this.slider.value = row;
      if (!run.num) return;
      const parts = [`${run.times[row].toFixed(1)} s`, `frame ${run.indices[row]}`, run.statusName(row), `${run.inliers[row]} inliers`];
      if (Number.isFinite(run.errors[row])) parts.push(`error ${number(run.errors[row])} ${run.unit}`);
      byId('time-text').textContent = parts.join(' · ');
      this.slider.setAttribute('aria-valuetext', parts.join(', '));
      this.showPicture(row);
    }
    showPicture(row) {
      const pictureRow = this.run.nearestPictureRow(row);
      byId('view').hidden = pictureRow < 0;
      if (pictureRow < 0 || pictureRow === this.pictureRow) return;
      this.pictureRow = pictureRow;
      const index = this.run.indices[pictureRow];
      byId('view-picture').src = this.run.picture(index);
      byId('view-picture').alt = `picture of frame ${index}`;
      byId('view-caption').textContent = `keyframe ${index} · ${this.run.times[pictureRow].toFixed(1)} s`;
    }

    togglePlay() {
      this.isPlaying = !this.isPlaying;
      byId('play').textContent = this.isPlaying ? '❚❚' : '▶';
      this.state.set('isGrowing', this.isPlaying);
      if (!this.isPlaying) return;
      if (this.state.get('row') >= this.run.num - 1) this.state.set('row', 0);
      // at least at the speed of the recording, and a whole run in half a minute
      const speed = Math.max(1, this.run.times[this.run.num - 1] / 30);
      let before = performance.now();
      let time = this.run.times[this.state.get('row')];
      const step = (now) => {
        if (!this.isPlaying) return;
        time += (speed * (now - before)) / 1000;
        before = now;
        let row = this.state.get('row');
        while (row < this.run.num - 1 && this.run.times[row + 1] <= time) ++row;
        this.state.set('row', row);
        if (row >= this.run.num - 1) this.togglePlay(); else requestAnimationFrame(step);
      };
      requestAnimationFrame(step);
    }

    drawStrip() {
      const canvas = byId('status-strip');
      const width = canvas.clientWidth || 300;
      canvas.width = width;
      canvas.height = 8;
      const pen = canvas.getContext('2d');
      const counts = new Map();
      for (let row = 0; row < this.run.num; ++row) counts.set(this.run.statusName(row), (counts.get(this.run.statusName(row)) || 0) + 1);
      for (let row = 0; row < this.run.num;) {
        let end = row;
        while (end < this.run.num && this.run.statuses[end] === this.run.statuses[row]) ++end;
        pen.fillStyle = samewhere.statusColour(this.run.statusName(row));
        pen.fillRect((row / this.run.num) * width, 0, Math.max(1.5, ((end - row) / this.run.num) * width), 8);
        row = end;
      }
      byId('status-key').replaceChildren(...[...counts].map(([name, count]) => {
        const swatch = element('i');
        swatch.style.background = samewhere.statusColour(name);
        return element('li', {}, swatch, samewhere.term(name), ` ${number(count)}`);
      }));
    }
  }
  samewhere.Timeline = Timeline;
})();
