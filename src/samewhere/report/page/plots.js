// Plots over time with one time axis: zoomed together, with a common cursor.
(function () {
  const { element, byId, number } = samewhere;
  const kMaxBins = 700;

  // Points of a line over [begin, end]; where there are more than fit, the least and the greatest
  // value of each stretch. A missing value is a gap.
  function thinned(times, values, begin, end) {
    const last = Math.min(times.length, values.length);
    let from = 0;
    while (from < last && times[from] < begin) ++from;
    let to = from;
    while (to < last && times[to] <= end) ++to;
    from = Math.max(0, from - 1);
    to = Math.min(last, to + 1);
    const step = Math.max(1, Math.ceil((to - from) / kMaxBins));
    const points = [];
    const add = (i) => points.push({ x: times[i], y: Number.isFinite(values[i]) ? values[i] : NaN });
    for (let i = from; i < to; i += step) {
      let least = i;
      let greatest = i;
      for (let k = i; k < Math.min(to, i + step); ++k) {
        if (!Number.isFinite(values[k])) { least = greatest = k; break; }
        if (values[k] < values[least]) least = k;
        if (values[k] > values[greatest]) greatest = k;
      }
      add(Math.min(least, greatest));
      if (least !== greatest) add(Math.max(least, greatest));
    }
    return points;
  }

  const pointStyles = { accepted: 'circle', false: 'cross', withdrawn: 'triangle', ambiguous: 'rectRot', rejected: 'crossRot' };

  class Plots {
    constructor(run, state) {
      this.run = run;
      this.state = state;
      this.whole = [0, run.num ? run.times[run.num - 1] : 1];
      this.span = this.whole;
      this.plots = [];
      if (!run.num) { byId('plots').hidden = true; return; }
      this.add('inliers', 'Inliers of tracking', () => [this.line('inliers', run.times, run.inliers, 'path')]);
      if (run.hasTruth) {
        this.add('error', `Position error, ${run.unit}`, () => [this.line('estimate', run.times, run.errors, 'path'),
          ...(run.hasOdometry ? [this.line('odometry', run.times, run.odometryErrors, 'odometry', [5, 3])] : [])]);
      }
      if (run.hasOdometry && !run.hasTruth) {
        this.add('correction', `Correction by loop closing, ${run.unit}`, () => [this.line('correction', run.times, run.corrections, 'path')]);
      }
      if (run.candidates.length || run.is_live) this.add('candidates', 'Inliers of loop candidates', () => this.scatter(), this.inlierLimit());
      if (run.durations_ms.length === run.num) {
        this.add('time', 'Time per frame, ms', () => [this.line('time', run.times, run.durations_ms, 'path')]);
      }
      if (run.memory.mib.length > 1) {
        const times = Array.from(run.memory.frames, (frame) => run.times[Math.min(frame, run.num - 1)]);
        this.add('memory', 'Memory of the program, MiB', () => [this.line('memory', times, run.memory.mib, 'path')]);
      }
      state.watch('theme', () => this.build());
      state.watch('candidates', () => this.refresh(['candidates']));
      state.watch('row', () => this.showCursor());
      state.onChange('changed', () => this.grow());
      byId('zoom-in').addEventListener('click', () => this.zoom(0.5));
      byId('zoom-out').addEventListener('click', () => this.zoom(2));
      byId('zoom-all').addEventListener('click', () => this.setSpan(this.whole));
    }

    inlierLimit() {
      const limit = this.run.limits.find((entry) => entry.score === 'num_inliers');
      return limit ? limit.value : null;
    }

    line(label, times, values, colour, dash = []) {
      return { label, type: 'line', data: thinned(times, values, ...this.span), borderColor: samewhere.css(colour), borderWidth: 1.4, borderDash: dash, pointRadius: 0, spanGaps: false };
    }
    scatter() {
      const shown = new Set(this.state.get('candidates'));
      return samewhere.kindNames.map((kind) => {
        const candidates = this.run.candidates.filter((candidate) => candidate.kind === kind && candidate.queryRow >= 0 && shown.has(candidate));
        return { label: kind, type: 'scatter', candidates, data: candidates.map((candidate) => ({ x: this.run.times[candidate.queryRow], y: candidate.scores.num_inliers || 0 })),
                 borderColor: samewhere.css(kind), backgroundColor: kind === 'rejected' ? samewhere.css(kind) : samewhere.css('card'), pointStyle: pointStyles[kind], pointRadius: kind === 'rejected' ? 3 : 6, borderWidth: kind === 'rejected' ? 1 : 2.4 };
      }).filter((set) => set.data.length);
    }

    add(name, title, sets, limit = null) {
      const canvas = element('canvas', { role: 'img', 'aria-label': `${title} over time` });
      const cursor = element('div', { class: 'cursor' });
      const band = element('div', { class: 'band', hidden: true });
      const box = element('div', { class: 'plot' }, canvas, cursor, band);
      byId('plot-grid').append(element('figure', { 'data-plot': name }, element('figcaption', {}, title), box));
      const plot = { name, sets, canvas, cursor, band, box, limit, chart: null };
      this.plots.push(plot);
      this.listen(plot);
    }

    build() {
      Chart.defaults.color = samewhere.css('soft');
      Chart.defaults.borderColor = samewhere.css('line');
      Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
      Chart.defaults.font.size = 11;
      for (const plot of this.plots) {
        if (plot.chart) plot.chart.destroy();
        plot.chart = new Chart(plot.canvas, { data: { datasets: plot.sets() }, options: this.options(plot), plugins: [this.limitLine(plot)] });
      }
      this.showCursor();
    }
    options(plot) {
      const numSets = plot.sets().length;
      return {
        animation: false, parsing: false, normalized: true, responsive: true, maintainAspectRatio: false, events: ['mousemove', 'mouseout'],
        interaction: { mode: plot.name === 'candidates' ? 'nearest' : 'index', intersect: plot.name === 'candidates', axis: 'x' },
        onResize: () => requestAnimationFrame(() => this.showCursor()),
        layout: { padding: { top: 2, right: 6 } },
        scales: {
          x: { type: 'linear', min: this.span[0], max: this.span[1], ticks: { maxTicksLimit: 6, maxRotation: 0, includeBounds: false, callback: (value) => `${number(value)} s` }, grid: { display: false } },
          y: { beginAtZero: true, suggestedMax: plot.limit === null ? undefined : 1.5 * plot.limit, ticks: { maxTicksLimit: 5 }, afterFit: (scale) => { scale.width = 38; } },
        },
        plugins: {
          legend: { display: numSets > 1, position: 'top', align: 'end', labels: { boxWidth: 18, boxHeight: 1, padding: 6, usePointStyle: plot.name === 'candidates' } },
          tooltip: { callbacks: { title: (items) => (items.length ? `${number(items[0].parsed.x)} s` : ''), label: (item) => this.label(item) } },
        },
      };
    }
    label(item) {
      const { candidates } = item.dataset;
      if (!candidates) return `${item.dataset.label}: ${number(item.parsed.y)}`;
      const candidate = candidates[item.dataIndex];
      return `${candidate.query} → ${candidate.matchName}: ${number(item.parsed.y)} inliers, ${samewhere.verdictText(candidate)}`;
    }
    // The threshold of the inliers.
    limitLine(plot) {
      return { id: 'limit', afterDatasetsDraw: (chart) => {
        if (plot.limit === null) return;
        const y = chart.scales.y.getPixelForValue(plot.limit);
        const { left, right } = chart.chartArea;
        const pen = chart.ctx;
        pen.save();
        pen.strokeStyle = samewhere.css('ink');
        pen.setLineDash([5, 4]);
        pen.beginPath();
        pen.moveTo(left, y);
        pen.lineTo(right, y);
        pen.stroke();
        pen.fillStyle = samewhere.css('ink');
        pen.textAlign = 'left';
        pen.setLineDash([]);
        pen.lineWidth = 4;
        pen.strokeStyle = samewhere.css('card');
        pen.strokeText(`threshold ${number(plot.limit)}`, left + 3, y - 4);
        pen.fillText(`threshold ${number(plot.limit)}`, left + 3, y - 4);
        pen.restore();
      } };
    }

    refresh(names) {
      for (const plot of this.plots) {
        if (!plot.chart || (names && !names.includes(plot.name))) continue;
        plot.chart.data.datasets = plot.sets();
        plot.chart.options.scales.x.min = this.span[0];
        plot.chart.options.scales.x.max = this.span[1];
        plot.chart.update('none');
      }
      this.showCursor();
    }
    // The run has become longer; a part of it that is shown stays.
    grow() {
      const isWhole = this.span[0] === this.whole[0] && this.span[1] === this.whole[1];
      this.whole = [0, Math.max(0.5, this.run.times[this.run.num - 1])];
      if (isWhole) this.span = this.whole;
      this.refresh();
    }
    setSpan(span) {
      const width = Math.max(0.5, Math.min(span[1] - span[0], this.whole[1] - this.whole[0]));
      const begin = Math.min(Math.max(this.whole[0], span[0]), this.whole[1] - width);
      this.span = [begin, begin + width];
      this.refresh();
    }
    zoom(factor, around = this.run.times[this.state.get('row')]) {
      const [begin, end] = this.span;
      const at = Math.min(end, Math.max(begin, around));
      this.setSpan([at - (at - begin) * factor, at + (end - at) * factor]);
    }

    showCursor() {
      const time = this.run.times[this.state.get('row')];
      for (const { chart, cursor } of this.plots) {
        if (!chart || !chart.chartArea) continue;
        const x = chart.scales.x.getPixelForValue(time);
        const { left, right, top, bottom } = chart.chartArea;
        cursor.hidden = x < left - 1 || x > right + 1;
        Object.assign(cursor.style, { left: `${x}px`, top: `${top}px`, height: `${bottom - top}px` });
      }
    }

    rowAt(time) {
      let row = 0;
      while (row < this.run.num - 1 && this.run.times[row + 1] <= time) ++row;
      return row;
    }
    listen(plot) {
      const { canvas, band } = plot;
      const time = (event) => plot.chart.scales.x.getValueForPixel(event.clientX - canvas.getBoundingClientRect().left);
      let begin = null;
      canvas.addEventListener('pointerdown', (event) => { begin = event.clientX; canvas.setPointerCapture(event.pointerId); });
      canvas.addEventListener('pointermove', (event) => {
        if (begin === null || Math.abs(event.clientX - begin) < 4) return;
        const { left } = canvas.getBoundingClientRect();
        band.hidden = false;
        Object.assign(band.style, { left: `${Math.min(begin, event.clientX) - left}px`, width: `${Math.abs(event.clientX - begin)}px` });
      });
      canvas.addEventListener('pointerup', (event) => {
        if (begin === null) return;
        const { left } = canvas.getBoundingClientRect();
        const ends = [begin, event.clientX].map((x) => plot.chart.scales.x.getValueForPixel(x - left)).sort((a, b) => a - b);
        band.hidden = true;
        if (Math.abs(event.clientX - begin) >= 4) this.setSpan(ends); else this.click(plot, event, time(event));
        begin = null;
      });
      canvas.addEventListener('dblclick', () => this.setSpan(this.whole));
      canvas.addEventListener('wheel', (event) => {
        event.preventDefault();
        this.zoom(event.deltaY > 0 ? 1.25 : 0.8, time(event));
      }, { passive: false });
    }
    click(plot, event, time) {
      const hits = plot.name === 'candidates' ? plot.chart.getElementsAtEventForMode(event, 'nearest', { intersect: true }, false) : [];
      if (hits.length) this.state.set('selected', plot.chart.data.datasets[hits[0].datasetIndex].candidates[hits[0].index]);
      else this.state.set('row', this.rowAt(time));
    }
  }
  samewhere.Plots = Plots;
  samewhere.thinned = thinned;
})();
