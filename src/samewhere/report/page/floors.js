// Floors of a building, and the section by height.
(function () {
  const { byId, element } = samewhere;
  const kBin = 0.3; // metres
  const kPeak = 3; // frames at the height of a floor, over the median of all heights
  const kStorey = 2.2; // metres between two floors, at least: half landings are none
  const kCameraHeight = 1.9; // above the ground, at most

  // Heights of the camera at which it stayed longest, lowest first. One, where there are no others.
  samewhere.floorsOf = function (run) {
    const counts = new Map();
    for (let row = 0; row < run.num; ++row) {
      const z = run.positions[3 * row + 2];
      if (!Number.isNaN(z)) counts.set(Math.round(z / kBin), (counts.get(Math.round(z / kBin)) || 0) + 1);
    }
    const median = [...counts.values()].sort((a, b) => a - b)[counts.size >> 1];
    const peaks = [];
    for (const [bin, count] of [...counts].sort((a, b) => b[1] - a[1] || a[0] - b[0])) {
      const isFar = peaks.every((peak) => Math.abs(peak - bin) * kBin >= kStorey);
      if (!peaks.length || (isFar && count >= kPeak * median)) peaks.push(bin);
    }
    return peaks.sort((a, b) => a - b).map((bin) => bin * kBin);
  };
  // The floor of a height; -1: between two, as on stairs.
  samewhere.floorAt = (floors, height) => floors.findIndex((floor) => Math.abs(floor - height) <= 2 * kBin);

  samewhere.startHeights = function (run, state) {
    const heights = Array.from(run.points.positions.filter((_, i) => i % 3 === 2)).sort((a, b) => a - b);
    byId('height-section').hidden = heights.length === 0 || Boolean(run.is_live);
    if (byId('height-section').hidden) return state.set('heights', [-1e6, 1e6]);
    const [low, high] = [0, heights.length - 1].map((i) => heights[i]);
    const sliders = [byId('height-low'), byId('height-high')];
    sliders.forEach((slider, i) => Object.assign(slider, { min: low, max: high, step: (high - low) / 200 || 1, value: i ? high : low }));
    const apply = () => {
      const values = sliders.map((slider) => Number(slider.value)).sort((a, b) => a - b);
      const isWhole = values[0] <= low + 1e-6 && values[1] >= high - (high - low) / 150;
      byId('height-text').textContent = isWhole ? 'all' : `${values[0].toFixed(1)} to ${values[1].toFixed(1)} ${run.unit}`;
      state.set('heights', isWhole ? [-1e6, 1e6] : values);
    };
    const floors = run.is_scale_unknown ? [] : samewhere.floorsOf(run);
    const select = byId('floor');
    select.hidden = floors.length < 2;
    select.append(element('option', { value: '' }, 'all floors'), ...floors.map((height, i) => element('option', { value: i }, `floor ${i + 1}, ${height.toFixed(1)} m`)));
    select.addEventListener('change', () => {
      const i = Number(select.value);
      const bounds = select.value === '' ? [low, high] : [i === 0 ? low : floors[i] - kCameraHeight, i + 1 < floors.length ? floors[i + 1] - kCameraHeight : high];
      sliders.forEach((slider, k) => { slider.value = bounds[k]; });
      apply();
    });
    sliders.forEach((slider) => slider.addEventListener('input', () => { select.value = ''; apply(); }));
    apply();
  };
})();
