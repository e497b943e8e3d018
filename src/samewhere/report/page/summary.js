// Title, headline figures, verification funnel, metrics, configuration.
(function () {
  const { element, byId, number } = samewhere;
  const plural = (count, one) => `${number(count)} ${one}${count === 1 ? '' : 's'}`;

  function lead(run) {
    const parts = [];
    if (run.num) {
      const measured = Array.from(run.statuses).filter((status, row) => run.position(row) && run.status_names[status] !== 'provisional').length;
      parts.push(`${plural(run.num, 'frame')}, ${number(measured)} with a measured pose.`);
    }
    if (!run.num_candidates) return [...parts, 'No loop candidates.'].join(' ');
    const counts = {};
    for (const candidate of run.candidates) counts[candidate.kind] = (counts[candidate.kind] || 0) + 1;
    const list = samewhere.kindNames.filter((kind) => counts[kind]).map((kind) => `${number(counts[kind])} ${kind}`);
    parts.push(`${plural(run.num_candidates, 'loop candidate')}: ${list.join(', ')}.`);
    return parts.join(' ');
  }

  // Figures that a reader looks for first.
  const headline = ['ATE RMSE (median, max)', 'ATE RMSE before loop closing', 'loops accepted: true / false / unknown', 'revisits closed', 'path length', 'frames with a measured pose'];
  function showHeadline(run) {
    const found = headline.map((name) => run.figures.find((figure) => figure.name === name)).filter(Boolean);
    const shown = (found.length ? found : run.figures.filter((figure) => figure.value.length < 20)).slice(0, 4);
    byId('headline').replaceChildren();
    for (const figure of shown) {
      const value = figure.value.replace(/ \(.*\)$/, '');
      byId('headline').append(element('div', { title: `${figure.name}: ${figure.value}` }, element('dt', {}, figure.name.replace(' (median, max)', '')), element('dd', {}, value)));
    }
  }

  function showWarnings(run) {
    byId('warnings').replaceChildren();
    const warn = (text) => byId('warnings').append(element('p', { class: 'warning' }, text));
    if (run.is_interrupted) warn('The run was interrupted; the report covers the frames up to there.');
    if (run.input_error) warn(`The input failed and the run ended there: ${run.input_error}`);
    if (run.num && run.statuses.length && !run.bounds().every(([low, high]) => Number.isFinite(low + high))) warn('No pose was measured.');
    if (run.num && !Array.from({ length: run.num }, (_, row) => run.position(row)).some(Boolean)) warn('No pose was measured.');
    if (run.is_scale_unknown) warn('Scale unknown: one camera without depth does not observe it. Lengths are in map units.');
  }

  function showFunnel(run, openCheck) {
    const total = run.num_candidates;
    const bar = (kind, count) => {
      const part = element('i', { class: kind });
      part.style.width = `${(100 * count) / total}%`;
      return count ? part : null;
    };
    const rows = run.checks.map((check) => element('button', { class: 'check', onclick: () => openCheck(check.name) },
      element('span', { class: 'name' }, samewhere.checkTerm(check.name), element('small', {}, check.question)),
      element('span', { class: 'bar' }, bar('passed', check.num_arrived - check.num_rejected - check.num_ambiguous), bar('ambiguous', check.num_ambiguous), bar('rejected', check.num_rejected)),
      element('span', { class: 'numbers' }, element('b', {}, number(check.num_rejected)), ` of ${number(check.num_arrived)} rejected`, check.num_ambiguous ? `, ${number(check.num_ambiguous)} ambiguous` : '')));
    const counts = (kind) => run.candidates.filter((candidate) => candidate.kind === kind).length;
    for (const kind of ['ambiguous', 'accepted', ...(counts('false') ? ['false'] : [])]) {
      rows.push(element('div', { class: 'check' }, element('span', { class: 'name' }, samewhere.term(kind)), element('span', { class: 'bar' }, bar(kind, counts(kind))), element('span', { class: 'numbers' }, element('b', {}, number(counts(kind))))));
    }
    byId('funnel').replaceChildren(...(total ? rows : [element('p', {}, 'The run has no loop candidates.')]));
  }

  function showTables(run) {
    byId('metrics').replaceChildren(...run.figures.map((figure) => element('tr', {}, element('th', {}, figure.name), element('td', {}, figure.value))));
    byId('stages-title').hidden = !run.stages.length;
    if (run.stages.length) {
      const numFrames = run.num || 1;
      byId('stages').replaceChildren(element('tr', {}, ...['stage', 'calls', 'median, ms', '95 %, ms', 'CPU, ms per frame'].map((name) => element('th', {}, name))),
        ...[...run.stages].sort((a, b) => b.processor_ms - a.processor_ms).map((stage) => element('tr', {}, element('th', {}, stage.name),
          ...[stage.count, stage.median_ms, stage.p95_ms, stage.processor_ms / numFrames].map((value) => element('td', {}, number(value))))));
    }
    byId('config').hidden = !run.config_yaml;
    byId('config-text').textContent = run.config_yaml;
  }

  // What was left out so that the page stays small.
  function showLimits(run) {
    const notes = [];
    const numPoints = run.points.positions.length / 3;
    if (numPoints < run.points.numInMap) notes.push(`${number(numPoints)} of ${number(run.points.numInMap)} landmarks are shown; those far outside and, of very many, every n-th are left out.`);
    if (run.candidates.length < run.num_candidates) notes.push(`${number(run.candidates.length)} of ${number(run.num_candidates)} candidates are on this page, the strongest; all are in loops.json.`);
    if (run.pictures.size < run.num_keyframe_pictures) notes.push(`${number(run.pictures.size)} of ${number(run.num_keyframe_pictures)} pictures of keyframes are on this page.`);
    const numMatched = run.candidates.filter((candidate) => candidate.matches).length;
    if (numMatched < run.candidates.length) notes.push(`Matches are drawn for ${number(numMatched)} candidates, the strongest between keyframes.`);
    byId('limits-note').textContent = notes.join(' ');
  }

  samewhere.showSummary = function (run, openCheck) {
    byId('title').textContent = run.title;
    byId('title').title = run.source;
    byId('lead').textContent = lead(run);
    showHeadline(run);
    showWarnings(run);
    showFunnel(run, openCheck);
    showTables(run);
    showLimits(run);
  };
})();
