// Puts the page together when its data has been read.
(function () {
  const { element, byId } = samewhere;

  samewhere.openTab = function (id) {
    for (const panel of document.querySelectorAll('[role=tabpanel]')) {
      panel.hidden = panel.id !== id;
      byId(panel.getAttribute('aria-labelledby')).setAttribute('aria-selected', panel.id === id);
    }
  };

  const block = (id) => JSON.parse(byId(id).textContent);

  // A part that the map has, to show or hide.
  function addLayer(state, name, text, isShown) {
    const box = element('input', { type: 'checkbox', onchange: () => state.set('layers', { ...state.get('layers'), [name]: box.checked }) });
    box.checked = isShown;
    state.set('layers', { ...state.get('layers'), [name]: isShown });
    const sample = element('i', { class: `line ${name}` });
    byId('layers').append(element('label', {}, box, name === 'points' || name === 'dense' ? null : sample, text));
  }
  function addLayers(run, state) {
    if (run.points.positions.length || run.is_live) addLayer(state, 'points', 'landmarks', true);
    if (run.dense) addLayer(state, 'dense', 'dense cloud', true);
    if (run.odometry.times.length) addLayer(state, 'odometry', 'odometry alone', true);
    if (run.truth.times.length) addLayer(state, 'truth', 'ground truth', true);
    if (run.covariances.length) addLayer(state, 'ellipses', 'covariance', false);
  }

  function startColours(run, state) {
    const select = byId('colour-by');
    const modes = samewhere.colourModes(run);
    select.append(...modes.map((mode) => element('option', { value: mode.name }, mode.text)));
    select.addEventListener('change', () => state.set('colourBy', select.value));
    const showLegend = () => samewhere.showLegend(run, state.get('colourBy'));
    state.watch('colourBy', (mode) => { select.value = mode; showLegend(); });
    state.watch('theme', showLegend);
    state.onChange('changed', showLegend);
    return () => {
      select.selectedIndex = (select.selectedIndex + 1) % modes.length;
      state.set('colourBy', select.value);
    };
  }

  function startMap(run, state) {
    const canvas = byId('canvas');
    if (!run.num) {
      byId('scene').hidden = byId('time').hidden = true;
      document.body.classList.add('without-map');
      return null;
    }
    const webGL = samewhere.probeWebGL();
    const is3d = webGL !== null;
    const map = is3d ? new samewhere.Scene(run, state, canvas, webGL) : new samewhere.Plan(run, state, canvas);
    const showNote = () => {
      const grid = is3d && !run.is_scale_unknown ? `Grid: ${samewhere.number(map.gridStep)} m. ` : '';
      byId('scene-note').textContent = is3d ? `${map.note || ''}${grid}Drag to turn, wheel to zoom, right button to move. Click a line.` : 'This browser has no WebGL: the map is shown from above. Drag to move, wheel to zoom, click a line.';
    };
    showNote();
    state.onChange('changed', showNote);
    byId('view-reset').addEventListener('click', () => map.look('whole'));
    byId('view-top').addEventListener('click', () => map.look('above'));
    byId('view-follow').addEventListener('click', () => {
      state.set('isFollowing', !state.get('isFollowing'));
      byId('view-follow').setAttribute('aria-pressed', state.get('isFollowing'));
      if (state.get('isFollowing') && map.showCamera) map.showCamera();
    });
    addEventListener('beforeprint', () => { map.resize(); map.renderNow(); });
    addEventListener('afterprint', () => map.resize());
    return map;
  }

  function startKeys(actions) {
    byId('keys').append(...actions.flatMap(([key, text]) => [element('dt', {}, element('kbd', {}, key === ' ' ? 'space' : key)), element('dd', {}, text)]));
    addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName) && event.target.type !== 'range') return;
      if (event.key === ' ' && event.target.tagName === 'BUTTON') return;
      const action = actions.find(([key]) => key.split(' or ').includes(event.key) || key === event.key);
      if (!action) return;
      event.preventDefault();
      action[2]();
    });
  }

  function show(run) {
    const state = new samewhere.State({ row: 0, selected: null, candidates: [], colourBy: 'time', theme: 'light', layers: {}, heights: null, isFollowing: false, isGrowing: false });
    const switchTheme = samewhere.startTheme([state]);
    const candidates = new samewhere.Candidates(run, state);
    const openCheck = (check) => { samewhere.openTab('candidates'); candidates.showCheck(check); };
    samewhere.showSummary(run, openCheck);
    state.onChange('changed', () => samewhere.showSummary(run, openCheck));
    const tabs = document.querySelectorAll('[role=tab]');
    tabs.forEach((tab) => tab.addEventListener('click', () => samewhere.openTab(tab.getAttribute('aria-controls'))));
    addLayers(run, state);
    samewhere.startHeights(run, state);
    const nextColour = startColours(run, state);
    const map = startMap(run, state);
    const timeline = new samewhere.Timeline(run, state);
    const plots = new samewhere.Plots(run, state);
    samewhere.startTooltips();
    samewhere.showGlossary();
    byId('theme').addEventListener('click', switchTheme);
    const help = () => byId('help-dialog').showModal();
    byId('help').addEventListener('click', help);
    const step = (by) => () => state.set('row', Math.min(run.num - 1, Math.max(0, state.get('row') + by)));
    startKeys([
      [' ', 'play or pause', () => timeline.togglePlay()],
      ['ArrowLeft', 'frame before', step(-1)], ['ArrowRight', 'next frame', step(1)],
      ['PageUp', '30 frames back', step(-30)], ['PageDown', '30 frames on', step(30)],
      ['j', 'next candidate', () => candidates.step(1)], ['k', 'candidate before', () => candidates.step(-1)],
      ['Escape', 'no candidate selected', () => state.set('selected', null)],
      ['r', 'whole map', () => map && map.look('whole')], ['t', 'map from above', () => map && map.look('above')],
      ['f', 'follow the camera', () => byId('view-follow').click()], ['c', 'next colour of the path', nextColour],
      ['+', 'zoom into the map', () => map && map.zoom(0.8)], ['-', 'zoom out of the map', () => map && map.zoom(1.25)],
      ['l', 'light or dark', switchTheme], ['?', 'keys', help],
    ]);
    if (run.num) state.set('row', run.num - 1);
    Object.assign(samewhere, { run, state, map, plots, timeline, candidates });
    document.documentElement.dataset.ready = Math.round(performance.now()); // ms since the page was opened
  }
  function start() {
    const live = block('live');
    if (live && live.mode === 'live') return samewhere.followRun(show);
    if (live) samewhere.stayOpen(live); // first: the rest takes its time
    show(new samewhere.Run(block('run'), block('pictures'), block('durations')));
    if (live) samewhere.selectByAddress();
  }
  document.addEventListener('DOMContentLoaded', start);
})();
