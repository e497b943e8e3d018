// A page that follows a run: the server sends what is new (README.md, Live), the parts of the page
// are told of it. Afterwards the page is that of the report, and tells the server that it is open.
(function () {
  const { byId, element, number, unpacked } = samewhere;
  const kLeastRest_ms = 120; // between two updates of the page
  const kRestPerWork = 4; // so that the page stays responsive however much it draws
  const columns = { indices: 1, stamps_s: 1, positions: 3, rotations: 4, statuses: 1, inliers: 1 };
  const ask = (path) => `${path}${location.search}`;

  samewhere.post = async function (path, wish) {
    const answer = await fetch(ask(path), { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(wish) });
    const text = await answer.text();
    if (!answer.ok) throw new Error(text.trim());
    return JSON.parse(text);
  };

  // The first rows of an array, then others.
  function joined(old, num, added) {
    if (!num) return added;
    const all = new added.constructor(num + added.length);
    all.set(old.subarray(0, num));
    all.set(added, num);
    return all;
  }

  function emptyData(start) {
    const path = () => ({ stamps_s: new Float64Array(0), positions: new Float32Array(0) });
    const frames = { num: 0, names: [] };
    for (const name of Object.keys(columns)) frames[name] = new Float32Array(0);
    return { ...start, is_live: true, figures: [], upright: { up: [0, -1, 0], right: [1, 0, 0] }, frames, odometry: path(), truth: path(),
             points: { positions: new Float64Array(0), colours: new Uint8Array(0), num_in_map: 0 }, num_candidates: 0, candidates: [], checks: [], num_keyframe_pictures: 0 };
  }

  class Live {
    constructor(show) {
      this.show = show; // puts the page together
      this.changed = {};
      this.buildBar();
      this.source = new EventSource(ask('/events'));
      for (const name of ['start', 'frames', 'pictures', 'candidates', 'points', 'status', 'image', 'pace', 'finished']) {
        this.source.addEventListener(name, (event) => this[name](JSON.parse(event.data)));
      }
      this.source.onopen = () => this.tell('');
      this.source.onerror = () => this.tell('No connection: the program has ended, or the page is too slow for it.');
      document.documentElement.dataset.mode = 'live';
    }

    // --- What the server sends.
    start(start) {
      this.data = emptyData(start);
      this.pictureList = [];
      this.candidateOf = new Map();
      byId('title').textContent = start.title;
      byId('live-pace').hidden = !start.may_wait;
      if (samewhere.state) samewhere.state.set('selected', null); // another session of a node
      if (start.is_recognition) this.change('all');
    }
    frames(event) {
      const { frames } = this.data;
      for (const [name, num] of Object.entries(columns)) frames[name] = joined(frames[name], num * event.from, unpacked(event[name]));
      if (event.names) frames.names = [...frames.names.slice(0, event.from), ...event.names];
      frames.num = event.from + event.num;
      frames.session = event.session;
      if (event.upright) this.data.upright = event.upright;
      this.change('frames');
      if (event.from === 0) this.change('all');
    }
    pictures(list) {
      this.pictureList.push(...list);
      this.data.num_keyframe_pictures = this.pictureList.length;
      this.change('candidates');
    }
    candidates(list) {
      for (const candidate of list) {
        const known = this.candidateOf.get(candidate.id);
        if (known) {
          const { verdict, stage, reason } = known;
          Object.assign(known, candidate, { earlier: [...(known.earlier || []), { verdict, stage, reason }] });
        } else {
          this.candidateOf.set(candidate.id, candidate);
          this.data.candidates.push(candidate);
        }
      }
      this.data.num_candidates = Math.max(this.data.num_candidates, this.data.candidates.length);
      this.change('candidates');
    }
    points(points) {
      this.data.points = { positions: unpacked(points.positions), colours: unpacked(points.colours), num_in_map: points.num_in_map };
      this.change('points');
    }
    status(status) {
      this.data.num_candidates = Math.max(status.num_candidates, this.data.candidates.length);
      this.data.checks = status.checks;
      const of = this.data.num_expected ? ` of ${number(this.data.num_expected)}` : '';
      const made = this.data.is_recognition ? `${number(status.num_candidates)} candidates` : `${number(status.num_keyframes)} keyframes · ${number(status.num_landmarks)} landmarks`;
      byId('live-text').textContent = `Frame ${number(status.num_frames)}${of} · ${status.phase} · ${made}${this.rate(status.num_frames)}`;
      byId('live-progress').value = this.data.num_expected ? status.num_frames / this.data.num_expected : 0;
      byId('live-progress').hidden = !this.data.num_expected;
    }
    image(image) {
      this.newest = image;
      this.drawImage();
    }
    pace(pace) {
      byId('live-pause').setAttribute('aria-pressed', pace.is_paused);
      byId('live-pause').textContent = pace.is_paused ? 'Go on' : 'Pause';
      byId('live-step').disabled = !pace.is_paused;
      byId('live-speed').value = String(pace.speed);
      document.documentElement.dataset.paused = pace.is_paused;
    }
    finished() { location.reload(); }

    // Frames per second over the last seconds.
    rate(numFrames) {
      const now = performance.now();
      this.counts = [...(this.counts || []).filter(([time]) => now - time < 5000), [now, numFrames]];
      const [time, num] = this.counts[0];
      return now - time > 500 ? ` · ${number((1000 * (numFrames - num)) / (now - time))} frames per second` : '';
    }

    // --- What the page shows.
    change(what) {
      this.changed[what] = true;
      if (this.isDue) return;
      this.isDue = true;
      setTimeout(() => this.update(), Math.max(0, (this.restUntil || 0) - performance.now()));
    }
    update() {
      this.isDue = false;
      const { changed, data } = this;
      if (!data.frames.num && !data.is_recognition) return;
      const begin = performance.now();
      this.changed = {};
      const run = new samewhere.Run(data, this.pictureList, { frames_ms: new Float32Array(0), stages: [] });
      if (samewhere.run) this.refresh(run, changed); else this.begin(run);
      const work = performance.now() - begin;
      this.restUntil = performance.now() + Math.max(kLeastRest_ms, kRestPerWork * work);
    }
    begin(run) {
      this.show(run);
      if (run.is_recognition) byId('side').before(byId('view')); // there is no map that it lies in
      samewhere.state.onChange('row', () => this.drawImage());
      this.drawImage();
    }
    refresh(run, changed) {
      const { state } = samewhere;
      const wasAtEnd = this.isAtEnd();
      Object.assign(samewhere.run, run);
      if (state.get('row') >= run.num) state.set('row', Math.max(0, run.num - 1));
      state.set('changed', changed);
      if (wasAtEnd) state.set('row', Math.max(0, run.num - 1));
    }
    isAtEnd() { return samewhere.run && samewhere.state.get('row') >= samewhere.run.num - 1; }

    // The current image with its features, in place of the keyframe's, while the newest frame is shown.
    drawImage() {
      const isShown = Boolean(this.newest) && this.isAtEnd();
      byId('view').classList.toggle('live', isShown);
      if (isShown && this.caption) this.showCaption();
      if (!isShown || this.drawn === this.newest) return;
      const { newest } = this;
      this.drawn = newest;
      const picture = new Image();
      picture.onload = () => { if (this.drawn === newest) this.paint(picture, newest); };
      picture.src = `data:image/jpeg;base64,${newest.jpeg_base64}`;
    }
    paint(picture, { frame, shares, are_tracked }) {
      const canvas = byId('view-features');
      Object.assign(canvas, { width: picture.width, height: picture.height });
      const pen = canvas.getContext('2d');
      pen.drawImage(picture, 0, 0);
      const at = unpacked(shares);
      const areTracked = unpacked(are_tracked);
      const draw = (isTracked, colour, size) => {
        pen.strokeStyle = colour;
        pen.lineWidth = 1.4;
        areTracked.forEach((value, i) => {
          if (Boolean(value) === isTracked) pen.strokeRect((at[2 * i] / 65535) * canvas.width - size, (at[2 * i + 1] / 65535) * canvas.height - size, 2 * size, 2 * size);
        });
      };
      draw(false, samewhere.css('idle'), 1);
      draw(true, samewhere.css('inlier-match'), 2.5);
      const numTracked = areTracked.reduce((sum, value) => sum + value, 0);
      Object.assign(canvas.dataset, { frame, tracked: numTracked });
      const features = `${number(areTracked.length)} features`;
      this.caption = `frame ${frame} · ${this.data.is_recognition ? features : `${number(numTracked)} of ${features} tracked`}`;
      if (this.isAtEnd()) this.showCaption();
    }
    showCaption() {
      byId('view').hidden = false;
      byId('view-caption').textContent = this.caption;
      samewhere.timeline.pictureRow = -1; // it shows the keyframe's again when the slider is moved
    }

    // --- What the run is asked for.
    buildBar() {
      byId('live-bar').hidden = false;
      const wish = (value) => samewhere.post('/control', value).catch((error) => this.tell(error.message));
      byId('live-pause').addEventListener('click', () => wish({ is_paused: byId('live-pause').getAttribute('aria-pressed') !== 'true' }));
      byId('live-step').addEventListener('click', () => wish({ step: true }));
      byId('live-speed').append(...[['0', 'as fast as possible'], ['1', 'as recorded'], ['0.5', '1/2'], ['0.25', '1/4'], ['0.1', '1/10']].map(([value, text]) => element('option', { value }, text)));
      byId('live-speed').addEventListener('change', () => wish({ speed: Number(byId('live-speed').value), is_paused: false }));
    }
    tell(text) { byId('live-note').textContent = text; }
  }

  samewhere.followRun = function (show) { samewhere.live = new Live(show); };

  // Where the server can override a verdict: what the details of a candidate have for it.
  function overrideNodes(path, candidate) {
    const isAccepted = candidate.kind === 'accepted';
    const note = element('p', { class: 'note', role: 'status' });
    const button = element('button', { class: 'override', onclick: async () => {
      button.disabled = true;
      note.textContent = 'The map is corrected …';
      try {
        await samewhere.post(path, { candidate: candidate.id, as: isAccepted ? 'reject' : 'force' });
        location.hash = `candidate-${candidate.id}`;
        location.reload();
      } catch (error) {
        note.textContent = error.message;
        button.disabled = false;
      }
    } }, isAccepted ? 'Reject by hand' : 'Accept by hand');
    return [element('p', { class: 'by-hand' }, button), note];
  }

  // A page of a finished run: the server goes on while it is open.
  samewhere.stayOpen = function (options) {
    document.documentElement.dataset.mode = options.mode;
    if (options.override) samewhere.overrideNodes = (candidate) => overrideNodes(options.override, candidate);
    const source = new EventSource(ask('/events'));
    source.onerror = () => { if (source.readyState === EventSource.CLOSED) source.close(); };
  };
  // After a verdict was overridden, its candidate is shown again.
  samewhere.selectByAddress = function () {
    const id = Number((location.hash.match(/^#candidate-(\d+)$/) || [])[1]);
    const shown = samewhere.run.candidates.find((candidate) => candidate.id === id);
    if (shown) samewhere.state.set('selected', shown);
  };
})();
