// The list of loop candidates, its filters, and the details of the selected one.
(function () {
  const { element, byId, number } = samewhere;
  const kFirstRows = 60;

  const kNear = 3; // of the camera, in the unit of the run

  const inliersOf = (candidate) => candidate.scores.num_inliers || 0;
  const orders = {
    'most inliers first': (a, b) => inliersOf(b) - inliersOf(a) || (b.scores.num_matches || 0) - (a.scores.num_matches || 0) || a.id - b.id,
    'in order of time': (a, b) => a.query - b.query || a.id - b.id,
    'most similar first': (a, b) => (b.scores.similarity || 0) - (a.scores.similarity || 0) || a.id - b.id,
  };
  const scores = { inliers: 'num_inliers', matches: 'num_matches', similarity: 'similarity' };

  class Candidates {
    constructor(run, state) {
      this.run = run;
      this.state = state;
      this.kinds = new Set(samewhere.kindNames);
      this.numShown = kFirstRows;
      this.shownMatches = { inliers: true, outliers: true };
      this.buildFilters();
      this.apply();
      state.watch('selected', (candidate) => this.show(candidate));
      state.watch('theme', () => this.drawDetail());
      state.onChange('changed', (changed) => this.refresh(changed));
    }

    // New candidates, verdicts, pictures or positions.
    refresh(changed) {
      if (!changed.candidates && !changed.all) return;
      byId('verdict-chips').replaceChildren();
      this.buildChips();
      const check = byId('check-filter').value;
      this.fillChecks();
      byId('check-filter').value = check;
      const { numShown } = this;
      this.apply(changed.candidates ? Math.max(kFirstRows, numShown) : 0);
    }

    buildChips() {
      const counts = {};
      for (const candidate of this.run.candidates) counts[candidate.kind] = (counts[candidate.kind] || 0) + 1;
      for (const kind of samewhere.kindNames) {
        const chip = element('button', { class: 'chip', 'aria-pressed': this.kinds.has(kind) ? 'true' : 'false', 'data-kind': kind, 'data-term': kind, onclick: () => this.toggle(kind, chip) },
          samewhere.lineSample(kind), `${kind} `, element('b', {}, number(counts[kind] || 0)));
        chip.disabled = !counts[kind];
        byId('verdict-chips').append(chip);
      }
    }

    buildFilters() {
      this.buildChips();
      this.fillSelects();
      for (const id of ['check-filter', 'order']) byId(id).addEventListener('change', () => this.apply());
      byId('score-filter').addEventListener('change', () => { byId('score-minimum').value = 0; this.apply(); });
      byId('score-minimum').addEventListener('input', () => this.apply());
      byId('near-unit').textContent = this.run.unit;
      byId('near-filter').addEventListener('change', () => this.apply());
      this.state.onChange('row', () => { if (byId('near-filter').checked) this.apply(); });
    }

    fillChecks() {
      const ofCheck = {};
      for (const candidate of this.run.candidates) {
        if (candidate.verdict !== 'LOOP') ofCheck[candidate.stage] = (ofCheck[candidate.stage] || 0) + 1;
      }
      byId('check-filter').replaceChildren(element('option', { value: '' }, 'all'),
        ...Object.entries(ofCheck).map(([check, count]) => element('option', { value: check }, `${check} (${count})`)));
    }
    fillSelects() {
      this.fillChecks();
      byId('order').append(...Object.keys(orders).map((name) => element('option', {}, name)));
      byId('score-filter').append(...Object.keys(scores).map((name) => element('option', {}, name)));
    }

    toggle(kind, chip) {
      if (this.kinds.has(kind)) this.kinds.delete(kind); else this.kinds.add(kind);
      chip.setAttribute('aria-pressed', this.kinds.has(kind));
      this.apply();
    }

    showCheck(check) {
      byId('check-filter').value = check;
      this.apply();
    }

    // The smallest score shown; the slider is finer at low scores.
    minimum(score) {
      const largest = Math.max(0, ...this.run.candidates.map((candidate) => candidate.scores[score] || 0));
      const share = Number(byId('score-minimum').value);
      const value = share * share * largest;
      return score === 'similarity' ? value : Math.round(value);
    }

    // Whether one of the two places is near the camera at the time shown.
    isNear(candidate) {
      const camera = this.run.position(this.state.get('row'));
      return Boolean(camera) && candidate.ends.some((end) => end && Math.hypot(...end.map((value, k) => value - camera[k])) <= kNear);
    }

    // numRows: of the list; 0: it stays as it is.
    apply(numRows = kFirstRows) {
      const check = byId('check-filter').value;
      const score = scores[byId('score-filter').value];
      const minimum = this.minimum(score);
      byId('score-text').textContent = minimum > 0 ? number(minimum) : 'all';
      const found = this.run.candidates.filter((candidate) => this.kinds.has(candidate.kind)
        && (!check || (candidate.verdict !== 'LOOP' && candidate.stage === check))
        && (minimum <= 0 || (candidate.scores[score] || 0) >= minimum) && (!byId('near-filter').checked || this.isNear(candidate)));
      found.sort(orders[byId('order').value]);
      this.found = found;
      this.tellCount();
      if (numRows) this.numShown = numRows;
      if (numRows) this.fillList();
      this.state.set('candidates', found);
    }

    tellCount() {
      const { length } = this.run.candidates;
      const noLine = this.run.num ? this.found.filter((candidate) => !candidate.hasLine).length : 0;
      byId('count').textContent = `${number(this.found.length)} of ${number(length)} candidates${noLine ? `, ${number(noLine)} of them without a line: a view has no pose` : ''}`;
      byId('count').dataset.count = this.found.length;
    }

    fillList() {
      const list = byId('list');
      list.replaceChildren(...this.found.slice(0, this.numShown).map((candidate) => this.row(candidate)));
      if (this.found.length > this.numShown) {
        list.append(element('li', {}, element('button', { class: 'more', onclick: () => { this.numShown += 200; this.fillList(); } },
          `Show more (${number(this.found.length - this.numShown)})`)));
      }
      if (!this.found.length) {
        list.append(element('li', { class: 'note' }, this.run.candidates.length ? 'No candidate passes the filters.' : 'The run has no loop candidates.'));
      }
      this.markSelected();
    }

    row(candidate) {
      const picture = (source, name) => (source ? element('img', { src: source, alt: name, loading: 'lazy' }) : element('span', { class: 'no-picture' }));
      const button = element('button', { class: `candidate ${candidate.kind}`, 'data-id': candidate.id, onclick: () => this.state.set('selected', candidate) },
        element('span', { class: 'pictures' }, picture(candidate.queryPicture, `frame ${candidate.query}`), picture(candidate.matchPicture, `frame ${candidate.matchName}`)),
        element('span', { class: 'words' },
          element('b', {}, `${candidate.query} → ${candidate.matchName}`),
          element('span', { class: 'verdict' }, samewhere.lineSample(candidate.kind), samewhere.verdictText(candidate)),
          element('small', {}, `${number(inliersOf(candidate))} inliers of ${number(candidate.scores.num_matches || 0)} matches`)));
      return element('li', {}, button);
    }

    markSelected() {
      const selected = this.state.get('selected');
      for (const button of byId('list').querySelectorAll('.candidate')) {
        const isSelected = selected && Number(button.dataset.id) === selected.id;
        button.setAttribute('aria-current', Boolean(isSelected));
        if (isSelected) button.scrollIntoView({ block: 'nearest' });
      }
    }

    // The next or previous candidate of the list.
    step(by) {
      if (!this.found.length) return;
      const at = this.found.indexOf(this.state.get('selected'));
      const next = at < 0 ? 0 : Math.min(this.found.length - 1, Math.max(0, at + by));
      this.state.set('selected', this.found[next]);
    }

    show(candidate) {
      byId('detail').hidden = !candidate;
      this.markSelected();
      if (!candidate) return;
      samewhere.openTab('candidates');
      this.detail = new samewhere.Detail(this.run, candidate, this.shownMatches, () => this.state.set('selected', null));
      byId('detail').replaceChildren(...this.detail.nodes);
      byId('detail').scrollTop = 0;
      this.drawDetail();
      if (candidate.queryRow >= 0) this.state.set('row', candidate.queryRow);
    }
    drawDetail() {
      if (this.detail && this.state.get('selected')) this.detail.draw();
    }
  }

  samewhere.verdictText = function (candidate) {
    if (candidate.kind === 'false') return 'accepted, false by the ground truth';
    if (candidate.kind === 'rejected') return `rejected: ${candidate.stage}`;
    if (candidate.kind === 'ambiguous') return `ambiguous: ${candidate.stage}`;
    return candidate.kind + (candidate.is_by_hand ? ' by hand' : '');
  };

  // Names of scores as they are read, with the term that explains them.
  const scoreNames = {
    similarity: ['similarity', 'similarity'], num_matches: ['matches', 'matches'], num_first_matches: ['first matches', 'matches'],
    num_inliers: ['inliers', 'inliers'], inlier_ratio: ['inlier ratio', 'inlier ratio'], spread_ratio: ['spread of the inliers', 'spread'],
    overlap_ratio: ['overlap of the images', 'overlap'], reprojection_rmse_px: ['reprojection error, px', null],
    pose_difference_m: ['difference of the two poses, m', 'consistency'], pose_difference_rad: ['difference of the two poses, degrees', 'consistency'],
    correction_m: ['correction, m', 'odometry gate'], correction_rad: ['correction, degrees', 'odometry gate'],
    mahalanobis_squared: ['chi-square by odometry', 'chi-square'], odometry_sigma_m: ['standard deviation of odometry, m', 'odometry'],
    mahalanobis_squared_with_loops: ['chi-square by odometry and loops', 'chi-square'], look_alike_gain: ['look-alike gain', 'look-alike gain'],
    look_alike_gain_with_loops: ['look-alike gain with loops', 'look-alike gain'],
    variance_factor: ['variance factor of odometry, learned from loops', 'odometry'], competing_loop: ['competing loop: match', 'competing'],
    competing_loop_apart_m: ['competing loop: distance, m', 'competing'], competing_loop_apart_rad: ['competing loop: angle, degrees', 'competing'],
    competing_loop_mahalanobis_squared: ['competing loop: chi-square', 'competing'], competing_loop_gain: ['gain over the competing loop', 'competing'],
    competing_loop_first: ['competing loop: candidate', 'competing'], competing_place: ['competing place: frame', 'competing'],
    competing_place_inliers: ['competing place: inliers', 'competing'], competing_place_apart_m: ['competing place: distance, m', 'competing'],
    competing_place_apart_rad: ['competing place: angle, degrees', 'competing'], num_sequence_views: ['consecutive views', 'sequence'],
    num_sequence_inliers: ['inliers of the sequence', 'sequence'], deformation_rmse_m: ['deformation, m', 'deformation'],
    deformation_path_m: ['length of the trajectory, m', 'deformation'], scale: ['scale', null], query_view: ['view of the query', 'sequence'], match_view: ['view of the match', 'sequence'],
  };
  const degrees = (name, value) => (name.endsWith('_rad') ? (value * 180) / Math.PI : value);

  class Detail {
    constructor(run, candidate, shownMatches, close) {
      this.run = run;
      this.candidate = candidate;
      this.shown = shownMatches;
      this.canvas = element('canvas', { class: 'pair', role: 'img', title: 'enlarge', 'aria-label': `frame ${candidate.query} and frame ${candidate.matchName}`, onclick: () => this.enlarge() });
      this.nodes = [this.heading(close), this.canvas, this.captions(), this.toggles(), ...this.sentences(),
        ...(samewhere.overrideNodes ? samewhere.overrideNodes(candidate) : []), this.table()];
    }

    heading(close) {
      const { candidate } = this;
      return element('div', { class: 'detail-head' },
        element('h2', { class: candidate.kind }, samewhere.lineSample(candidate.kind), samewhere.verdictText(candidate)),
        element('button', { class: 'close', 'aria-label': 'close', title: 'close (Esc)', onclick: close }, '✕'));
    }
    captions() {
      const name = (row) => (row >= 0 ? this.run.names[row] : '');
      const at = (row) => (row >= 0 ? `, ${number(this.run.times[row])} s` : '');
      const { candidate } = this;
      return element('div', { class: 'captions' },
        element('span', { title: name(candidate.queryRow) }, `query: frame ${candidate.query}${at(candidate.queryRow)}`),
        element('span', { title: name(candidate.matchRow) }, `match: frame ${candidate.matchName}${at(candidate.matchRow)}`));
    }
    toggles() {
      const matches = samewhere.matchesOf(this.candidate);
      if (!matches) return element('p', { class: 'note' }, 'Matches are kept for the strongest candidates between keyframes only.');
      const numInliers = matches.areInliers.reduce((sum, value) => sum + value, 0);
      const box = (name, text) => {
        const input = element('input', { type: 'checkbox', onchange: () => { this.shown[name] = input.checked; this.draw(); } });
        input.checked = this.shown[name];
        return element('label', { class: name }, input, text);
      };
      return element('div', { class: 'toggles', title: 'Marks for all of them, lines for an even share' }, box('inliers', `○ ${numInliers} matches fit the pose`),
        box('outliers', `× ${matches.areInliers.length - numInliers} do not`));
    }
    sentences() {
      const { candidate } = this;
      const reason = candidate.reason.charAt(0).toUpperCase() + candidate.reason.slice(1);
      const nodes = [element('p', { class: 'reason' }, `${reason}.`)];
      if (candidate.trueDistance !== null) {
        nodes.push(element('p', { class: 'truth' }, `Ground truth: the cameras of the two views are ${number(candidate.trueDistance)} ${this.run.unit} apart.`));
      }
      for (const earlier of candidate.earlier || []) {
        nodes.push(element('p', { class: 'earlier' }, `Earlier verdict: ${earlier.verdict === 'LOOP' ? 'accepted' : earlier.verdict === 'NOT' ? 'rejected' : 'ambiguous'}, ${earlier.reason}.`));
      }
      return nodes;
    }

    limitOf(name) {
      const limit = this.run.limits.find((entry) => entry.score === name);
      if (!limit) return null;
      const value = limit.share_of ? limit.value * (this.candidate.scores[limit.share_of] || 0) : limit.value;
      return { ...limit, value };
    }
    table() {
      const table = element('table', { class: 'scores' }, element('thead', {}, element('tr', {}, element('th', {}, 'score'), element('th', {}, 'measured'), element('th', {}, 'threshold'), element('th', {}, ''))));
      const body = element('tbody');
      for (const [name, value] of Object.entries(this.candidate.scores)) body.append(this.scoreRow(name, value));
      table.append(body);
      return table;
    }
    scoreRow(name, value) {
      const [text, term] = scoreNames[name] || [name, null];
      const limit = this.limitOf(name);
      const row = element('tr', {}, element('td', {}, term ? samewhere.term(term, text) : text), element('td', {}, number(degrees(name, value))));
      if (!limit || value === null) {
        row.append(element('td'), element('td'));
        return row;
      }
      const isPassed = limit.is_minimum ? value >= limit.value : value <= limit.value;
      row.append(element('td', { title: limit.setting }, `${limit.is_minimum ? '≥' : '≤'} ${number(degrees(name, limit.value))}`),
        element('td', { class: isPassed ? 'pass' : 'fail', 'aria-label': isPassed ? 'passed' : 'failed' }, isPassed ? '✓' : '✗'));
      if (!isPassed) row.className = 'fails';
      return row;
    }

    draw() { return samewhere.drawPair(this.canvas, this.candidate, this.shown); }
    enlarge() {
      const dialog = byId('pair-dialog');
      dialog.showModal();
      byId('pair-large-text').textContent = `Frames ${this.candidate.query} and ${this.candidate.matchName}: ${samewhere.verdictText(this.candidate)}. ${this.candidate.reason}`;
      samewhere.drawPair(byId('pair-large'), this.candidate, { ...this.shown, scale: 1.4 });
    }
  }
  samewhere.Detail = Detail;
  samewhere.Candidates = Candidates;
})();
