// Colours: those of the style sheet, and scales for the path. Distinct with any colour vision
// (Okabe and Ito; viridis, cividis and plasma).
(function () {
  samewhere.css = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

  const scales = {
    time: ['#440154', '#482878', '#3e4a89', '#31688e', '#26828e', '#1f9e89', '#35b779', '#6ece58', '#b5de2b', '#fde725'],
    height: ['#00224e', '#2a3f6d', '#575d6d', '#7d7c78', '#a59c74', '#d2c060', '#fee838'],
    error: ['#0d0887', '#5302a3', '#8b0aa5', '#b83289', '#db5c68', '#f48849', '#febc2a', '#f0f921'],
  };
  // On a dark ground the dark end of a scale is not seen: it begins later; on a light one it ends earlier.
  const part = () => (samewhere.isDark() ? [0.22, 1] : [0, 0.86]);

  function channels(hex) {
    return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
  }
  samewhere.channels = (colour) => channels(colour.startsWith('#') && colour.length === 7 ? colour : '#888888');

  samewhere.isDark = () => document.documentElement.dataset.theme === 'dark';

  // Red, green and blue from 0 to 1, of a share from 0 to 1.
  samewhere.scaleColour = function (scale, share) {
    const colours = scales[scale];
    const [first, last] = part();
    const at = (first + (last - first) * Math.min(1, Math.max(0, share))) * (colours.length - 1);
    const low = Math.min(colours.length - 2, Math.floor(at));
    const a = channels(colours[low]);
    const b = channels(colours[low + 1]);
    return a.map((value, k) => value + (b[k] - value) * (at - low));
  };
  samewhere.scaleGradient = function (scale) {
    const stops = [];
    for (let i = 0; i <= 10; ++i) {
      stops.push(`rgb(${samewhere.scaleColour(scale, i / 10).map((value) => Math.round(255 * value)).join(' ')})`);
    }
    return `linear-gradient(to right, ${stops.join(', ')})`;
  };

  const statusVariables = { initializing: 'idle', tracking: 'tracking', weak: 'weak', lost: 'lost', relocalized: 'relocalized', provisional: 'provisional' };
  samewhere.statusColour = (name) => samewhere.css(statusVariables[name] || 'idle');

  // How a kind of candidate is drawn: width in pixels, dash and gap in pixels, mark.
  samewhere.lineStyles = {
    accepted: { width: 4, dash: null, opacity: 1, mark: 'circle', word: 'accepted' },
    false: { width: 5, dash: null, opacity: 1, mark: 'cross', word: 'false' },
    withdrawn: { width: 3, dash: [10, 4], opacity: 0.95, mark: 'triangle', word: 'withdrawn' },
    ambiguous: { width: 2, dash: [2, 4], opacity: 0.9, mark: 'diamond', word: 'ambiguous' },
    rejected: { width: 1, dash: null, opacity: 0.6, mark: null, word: 'rejected' },
  };
  // false: accepted, and the ground truth contradicts it
  samewhere.kindNames = ['accepted', 'false', 'withdrawn', 'ambiguous', 'rejected'];

  // Light or dark as the system prefers, until switched by the function returned; light on paper.
  samewhere.startTheme = function (states) {
    const preferred = matchMedia('(prefers-color-scheme: dark)');
    const apply = (isDark) => {
      const theme = isDark ? 'dark' : 'light';
      document.documentElement.dataset.theme = theme;
      states.forEach((state) => state.set('theme', theme));
    };
    preferred.addEventListener('change', (event) => apply(event.matches));
    apply(preferred.matches);
    let isDarkOnScreen = false;
    addEventListener('beforeprint', () => { isDarkOnScreen = samewhere.isDark(); apply(false); });
    addEventListener('afterprint', () => apply(isDarkOnScreen));
    return () => apply(!samewhere.isDark());
  };

  // A short piece of the line of a kind, for legends.
  samewhere.lineSample = function (kind) {
    const style = samewhere.lineStyles[kind];
    const sample = samewhere.element('i', { class: `line ${kind}` });
    sample.dataset.mark = style.mark || '';
    return sample;
  };

  samewhere.colourModes = function (run) {
    const modes = [{ name: 'time', text: 'time' }];
    if (run.hasTruth) modes.push({ name: 'error', text: 'position error' });
    modes.push({ name: 'status', text: 'tracking status' }, { name: 'height', text: 'height' });
    if (samewhere.floorsOf && !run.is_scale_unknown && !run.is_live && samewhere.floorsOf(run).length > 1) modes.push({ name: 'floor', text: 'floor' });
    return modes;
  };
  // The scale of a mode: range of values, and the colour of a frame.
  samewhere.pathColouring = function (run, mode) {
    if (mode === 'status') {
      return { colour: (row) => samewhere.channels(samewhere.statusColour(run.statusName(row))) };
    }
    if (mode === 'floor') {
      const floors = samewhere.floorsOf(run);
      const share = (row) => samewhere.floorAt(floors, run.positions[3 * row + 2]) / Math.max(1, floors.length - 1);
      return { colour: (row) => (share(row) < 0 ? samewhere.channels(samewhere.css('idle')) : samewhere.scaleColour('time', share(row))) };
    }
    const valueOf = (of, row) => ({ time: of.times[row], error: of.errors[row], height: of.positions[3 * row + 2] })[mode];
    const value = (row) => valueOf(run, row);
    let low = Infinity;
    let high = -Infinity;
    for (const of of run.beside || [run]) { // runs that are compared have one scale
      for (let row = 0; row < of.num; ++row) {
        if (!Number.isFinite(valueOf(of, row))) continue;
        low = Math.min(low, valueOf(of, row));
        high = Math.max(high, valueOf(of, row));
      }
    }
    const span = high - low || 1;
    const unit = mode === 'time' ? 's' : run.unit;
    return { low, high, unit, gradient: samewhere.scaleGradient(mode),
             colour: (row) => (Number.isFinite(value(row)) ? samewhere.scaleColour(mode, (value(row) - low) / span) : samewhere.channels(samewhere.css('idle'))) };
  };
  samewhere.showLegend = function (run, mode) {
    const colouring = samewhere.pathColouring(run, mode);
    const legend = samewhere.byId('legend');
    legend.replaceChildren();
    if (!colouring.gradient) return;
    const bar = samewhere.element('span', { class: 'gradient' });
    bar.style.background = colouring.gradient;
    const end = (value) => `${samewhere.number(value)} ${colouring.unit}`;
    legend.append(end(colouring.low), bar, end(colouring.high));
  };
})();
