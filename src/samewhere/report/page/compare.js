// Runs side by side: their maps under one camera, loops and false loops, what the verifier of one run said of the
// false loops of another, metrics and settings that differ.
(function () {
  const { element, byId, number } = samewhere;
  const kShownFirst = ['accepted', 'false', 'withdrawn'];
  const numFalse = (run) => run.candidates.filter((candidate) => candidate.kind === 'false').length;

  // Runs of one source begin at one pose: they are shown in the axes of the run with the least error, and with the
  // ground truth as it is aligned with that one.
  function readRuns() {
    const entries = JSON.parse(byId('runs').textContent);
    const runs = entries.map(({ name, run, pictures, durations }) => Object.assign(new samewhere.Run(run, pictures, durations), { name }));
    const error = (run) => run.errors.reduce((sum, value) => sum + (Number.isNaN(value) ? 0 : value * value), 0);
    const best = runs.reduce((a, b) => (error(b) < error(a) ? b : a));
    const placed = entries.map(({ name, run, pictures, durations }, i) => (run.source !== best.source ? runs[i]
      : Object.assign(new samewhere.Run({ ...run, upright: best.upright }, pictures, durations), { name })));
    const truth = placed[runs.indexOf(best)].truth;
    return placed.map((run) => Object.assign(run, { beside: placed, ...(run.source === best.source ? { truth } : {}) }));
  }

  function union(rooms) {
    return [0, 1, 2].map((axis) => [Math.min(...rooms.map((room) => room[axis][0])), Math.max(...rooms.map((room) => room[axis][1]))]);
  }

  // The part of a configuration that YAML has below its sections, as "section.key": value.
  function settingsOf(yaml) {
    const settings = new Map();
    const path = [];
    for (const line of yaml.split('\n')) {
      const found = /^( *)([\w-]+): *(.*?) *$/.exec(line.replace(/\s+#.*$/, ''));
      if (!found) continue;
      const depth = found[1].length / 2;
      path.length = depth;
      path[depth] = found[2];
      if (found[3] !== '') settings.set(path.join('.'), found[3]);
    }
    return settings;
  }

  class Column {
    constructor(run, room, webGL) {
      this.run = run;
      this.canvas = element('canvas', { tabindex: 0, 'aria-label': `map of ${run.name}` });
      byId('run-columns').append(element('section', { class: 'run-column' },
        element('div', { class: 'run-head' }, element('h2', {}, run.name), this.headline()),
        element('div', { class: 'view-of-run' }, this.canvas)));
      this.state = new samewhere.State({ row: Math.max(0, run.num - 1), selected: null, candidates: [], colourBy: run.hasTruth ? 'error' : 'time', theme: samewhere.isDark() ? 'dark' : 'light', layers: {}, heights: [-1e6, 1e6], isFollowing: false, isGrowing: false });
      this.map = webGL ? new samewhere.Scene(run, this.state, this.canvas, { ...webGL, room }) : new samewhere.Plan(run, this.state, this.canvas);
    }

    headline() {
      const value = (name) => (this.run.figures.find((figure) => figure.name.startsWith(name)) || { value: '' }).value.replace(/ \(.*\)$/, '');
      const entry = (term, text, kind) => (text === '' ? null : element('div', {}, element('dt', {}, term), element('dd', { class: kind }, text)));
      const accepted = this.run.candidates.filter((candidate) => candidate.verdict === 'LOOP').length;
      const isFalse = numFalse(this.run);
      return element('dl', {}, entry('ATE RMSE', value('ATE RMSE (median, max)')), entry('loops accepted', number(accepted)),
        this.run.hasTruth ? entry('of these false', number(isFalse), isFalse ? 'bad' : 'good') : null, entry('revisits closed', value('revisits closed')));
    }

    show(kinds) {
      this.state.set('candidates', this.run.candidates.filter((candidate) => kinds.has(candidate.kind)));
    }

    showTime(time) {
      let row = 0;
      while (row < this.run.num - 1 && this.run.times[row + 1] <= time) ++row;
      this.state.set('row', row);
    }

    // The candidate of this run for the views of a candidate of another; null: none.
    nearest(candidate) {
      let best = null;
      let least = Infinity;
      const sameFrames = JSON.parse(byId('same-frames').textContent);
      for (const other of this.run.candidates) {
        const apart = [Math.abs(other.query - candidate.query), Math.abs(other.match - candidate.match)];
        if (Math.max(...apart) > sameFrames || apart[0] + apart[1] >= least) continue;
        best = other;
        least = apart[0] + apart[1];
      }
      return best;
    }
  }

  class Comparison {
    constructor(runs) {
      this.runs = runs;
      const webGL = samewhere.probeWebGL();
      const room = union(runs.map((run) => samewhere.roomOf(run)));
      this.columns = runs.map((run) => new Column(run, room, webGL));
      if (webGL) samewhere.Scene.link(this.columns.map((column) => column.map));
      this.kinds = new Set(kShownFirst);
      this.columns.forEach((column) => {
        column.show(this.kinds);
        column.state.onChange('selected', (candidate) => this.showDetails(column, candidate));
      });
      this.columns[0].map.look('whole', false);
    }

    get states() { return this.columns.map((column) => column.state); }
    set(name, value) { this.states.forEach((state) => state.set(name, value)); }

    addControls() {
      byId('view-reset').addEventListener('click', () => this.columns[0].map.look('whole'));
      byId('view-top').addEventListener('click', () => this.columns[0].map.look('above'));
      const modes = samewhere.colourModes({ hasTruth: this.runs.every((run) => run.hasTruth) });
      byId('colour-by').append(...modes.map((mode) => element('option', { value: mode.name }, mode.text)));
      byId('colour-by').value = this.states[0].get('colourBy');
      const showLegend = () => samewhere.showLegend(this.runs[0], this.states[0].get('colourBy'));
      byId('colour-by').addEventListener('change', () => { this.set('colourBy', byId('colour-by').value); showLegend(); });
      this.states[0].watch('theme', showLegend);
      const layers = [['points', 'landmarks', true], ['odometry', 'odometry alone', false], ['truth', 'ground truth', true]];
      this.set('layers', { ellipses: false, ...Object.fromEntries(layers.map(([name, , isShown]) => [name, isShown])) });
      for (const [name, text, isShown] of layers) {
        byId('layers').append(this.box(text, name === 'points' ? null : element('i', { class: `line ${name}` }), isShown,
          (isOn) => this.set('layers', { ...this.states[0].get('layers'), [name]: isOn })));
      }
      for (const kind of samewhere.kindNames) {
        if (!this.runs.some((run) => run.candidates.some((candidate) => candidate.kind === kind))) continue;
        byId('kinds').append(this.box(kind, samewhere.lineSample(kind), this.kinds.has(kind), (isOn) => {
          if (isOn) this.kinds.add(kind); else this.kinds.delete(kind);
          this.columns.forEach((column) => column.show(this.kinds));
        }));
      }
      this.addTime();
    }
    box(text, sample, isShown, change) {
      const input = element('input', { type: 'checkbox', onchange: () => change(input.checked) });
      input.checked = isShown;
      return element('label', {}, input, sample, text);
    }
    addTime() {
      const end = Math.max(...this.runs.map((run) => (run.num ? run.times[run.num - 1] : 0)));
      const slider = byId('time-slider');
      Object.assign(slider, { max: end, step: end / 1000 || 1, value: end });
      const show = () => {
        this.columns.forEach((column) => column.showTime(Number(slider.value)));
        byId('time-text').textContent = `${Number(slider.value).toFixed(1)} s`;
      };
      slider.addEventListener('input', show);
      byId('play').addEventListener('click', () => this.togglePlay(end, show));
      show();
    }
    // Paths and loops grow while the runs are played, in ten seconds at most.
    togglePlay(end, show) {
      const slider = byId('time-slider');
      this.isPlaying = !this.isPlaying;
      this.set('isGrowing', this.isPlaying);
      byId('play').textContent = this.isPlaying ? '❚❚' : '▶';
      if (!this.isPlaying) return;
      if (Number(slider.value) >= end * 0.999) slider.value = 0;
      const speed = Math.max(1, end / 10);
      let before = performance.now();
      const step = (now) => {
        if (!this.isPlaying) return;
        slider.value = Number(slider.value) + (speed * (now - before)) / 1000;
        before = now;
        show();
        if (Number(slider.value) >= end * 0.999) byId('play').click(); else requestAnimationFrame(step);
      };
      requestAnimationFrame(step);
    }

    // The candidate in each run, if its verifier saw one of the same views.
    showDetails(column, candidate) {
      byId('details').hidden = !candidate;
      byId('details').replaceChildren();
      if (!candidate) return;
      const shown = { inliers: true, outliers: true };
      for (const other of this.columns) {
        if (other !== column) other.state.set('selected', null);
      }
      byId('details').hidden = false;
      for (const other of this.columns) {
        const found = other === column ? candidate : other.nearest(candidate);
        if (!found) {
          byId('details').append(element('article', {}, element('h3', {}, other.run.name), element('p', {}, 'Place recognition proposed no candidate of these views.')));
          continue;
        }
        const detail = new samewhere.Detail(other.run, found, shown, () => column.state.set('selected', null));
        byId('details').append(element('article', {}, element('h3', {}, other.run.name), ...detail.nodes));
        detail.draw();
      }
    }

    // A sentence and bars for each pair of runs.
    showJudged(entries) {
      for (const { accepted_by: by, judged_by: judge, verdicts } of entries) {
        const total = verdicts.reduce((sum, { count }) => sum + count, 0);
        const bar = ({ verdict, count }) => {
          const part = element('i', { class: verdict === 'accepted' ? 'accepted-too' : '' });
          part.style.width = `${(100 * count) / total}%`;
          const name = verdict.replace(/^\w+: /, '');
          return element('div', { class: 'check' }, element('span', { class: 'name' }, verdict === name ? verdict : [`${verdict.slice(0, -name.length)}`], verdict === name ? '' : samewhere.checkTerm(name)),
            element('span', { class: 'bar' }, part), element('b', {}, number(count)));
        };
        byId('judged').append(element('div', { class: 'verdicts' },
          element('h2', {}, `The ${number(total)} false loop ${total === 1 ? 'closure' : 'closures'} of ${this.runs[by].name}, as ${this.runs[judge].name} judged the same views`), ...verdicts.map(bar)));
      }
    }

    showTables() {
      const header = element('tr', {}, element('th', {}, ''), ...this.runs.map((run) => element('td', {}, element('b', {}, run.name))));
      const names = [...new Set(this.runs.flatMap((run) => run.figures.map((figure) => figure.name)))];
      const row = (name, values) => element('tr', {}, element('th', {}, name), ...values.map((value) => element('td', {}, value === undefined ? '–' : value)));
      byId('metrics').append(header.cloneNode(true), ...names.map((name) => row(name, this.runs.map((run) => (run.figures.find((figure) => figure.name === name) || {}).value))));
      const settings = this.runs.map((run) => settingsOf(run.config_yaml));
      const keys = [...new Set(settings.flatMap((map) => [...map.keys()]))].filter((key) => new Set(settings.map((map) => map.get(key))).size > 1);
      byId('settings').append(header, ...keys.map((key) => row(key, settings.map((map) => map.get(key)))));
    }
  }

  function start() {
    const runs = readRuns();
    const isOneSource = new Set(runs.map((run) => run.source)).size === 1;
    byId('title').textContent = runs.map((run) => run.name).join(' and ');
    byId('lead').textContent = isOneSource ? `Runs of one recording: ${runs[0].title}. Click a line to see both views and every score.` : 'Runs of different recordings. Click a line to see both views and every score.';
    document.documentElement.dataset.theme = matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
    const comparison = new Comparison(runs);
    comparison.addControls();
    comparison.showJudged(JSON.parse(byId('judged-data').textContent));
    comparison.showTables();
    samewhere.startTooltips();
    const switchTheme = samewhere.startTheme(comparison.states);
    byId('theme').addEventListener('click', switchTheme);
    const keys = { ' ': () => byId('play').click(), r: () => byId('view-reset').click(), t: () => byId('view-top').click(), l: switchTheme, Escape: () => comparison.set('selected', null) };
    addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
      if (event.key === ' ' && event.target.tagName === 'BUTTON') return;
      event.preventDefault();
      keys[event.key]();
    });
    samewhere.comparison = comparison;
    document.documentElement.dataset.ready = Math.round(performance.now()); // ms since the page was opened
  }
  document.addEventListener('DOMContentLoaded', start);
})();
