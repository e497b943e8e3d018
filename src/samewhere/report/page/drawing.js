// What scenes draw with: sprites, lines, the ellipses of a covariance.
(function () {
  const element = samewhere.element;

  const sprites = new Map(); // made once, for any number of updates
  function sprite(...look) {
    const key = look.join();
    if (!sprites.has(key)) sprites.set(key, makeSprite(...look));
    return sprites.get(key);
  }
  function makeSprite(mark, colour, ground) {
    const canvas = element('canvas', { width: 64, height: 64 });
    const pen = canvas.getContext('2d');
    pen.beginPath();
    if (mark === 'dot') pen.arc(32, 32, 26, 0, 7);
    if (mark === 'circle') pen.arc(32, 32, 20, 0, 7);
    if (mark === 'diamond') { pen.moveTo(32, 6); pen.lineTo(56, 32); pen.lineTo(32, 58); pen.lineTo(8, 32); }
    if (mark === 'cross') { pen.moveTo(12, 12); pen.lineTo(52, 52); pen.moveTo(52, 12); pen.lineTo(12, 52); }
    if (mark === 'triangle') { pen.moveTo(32, 8); pen.lineTo(58, 54); pen.lineTo(6, 54); }
    if (mark !== 'cross') pen.closePath();
    pen.fillStyle = ground;
    pen.fill();
    pen.lineWidth = mark === 'cross' ? 16 : 10;
    pen.strokeStyle = colour;
    pen.stroke();
    return new THREE.CanvasTexture(canvas);
  }

  // Lines of a width in pixels.
  function wideLines(positions, options) {
    const geometry = new THREE.LineSegmentsGeometry();
    geometry.setPositions(positions);
    const material = new THREE.LineMaterial({ color: options.colour, linewidth: options.width, dashed: Boolean(options.dash), depthTest: options.depthTest !== false });
    if (options.dash) {
      material.defines.USE_DASH = '';
      [material.dashSize, material.gapSize] = options.dash;
    }
    if (options.clip) Object.assign(material, { clipping: true, clippingPlanes: options.clip });
    material.transparent = true;
    material.uniforms.opacity.value = options.opacity || 1; // the renderer does not pass it on
    const lines = new THREE.LineSegments2(geometry, material);
    if (options.dash) lines.computeLineDistances();
    lines.frustumCulled = false;
    lines.renderOrder = options.order || 1;
    return lines;
  }

  // Rows of a path that continue the row before: both have a position, and no `isBreak(row)`.
  function continuedRows(positions, num, isBreak = () => false) {
    const rows = [];
    for (let row = 1; row < num; ++row) {
      if (!Number.isNaN(positions[3 * row]) && !Number.isNaN(positions[3 * row - 3]) && !isBreak(row)) rows.push(row);
    }
    return rows;
  }
  function segments(positions, rows) {
    const values = new Float32Array(6 * rows.length);
    rows.forEach((row, i) => values.set(positions.subarray(3 * row - 3, 3 * row + 3), 6 * i));
    return values;
  }

  // Lines of one pixel, which any machine draws fast.
  function thinLines(values, options) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(values), 3));
    const common = { color: options.colour, transparent: true, opacity: options.opacity || 1, depthWrite: false, clippingPlanes: options.clip || null };
    const material = options.dash ? new THREE.LineDashedMaterial({ ...common, dashSize: options.dash[0], gapSize: options.dash[1] }) : new THREE.LineBasicMaterial(common);
    const lines = new THREE.LineSegments(geometry, material);
    if (options.dash) lines.computeLineDistances();
    lines.renderOrder = options.order || 2;
    return lines;
  }

  // Pairs of half axes of the 95 % ellipsoid of a covariance (xx, xy, xz, yy, yz, zz, of the world).
  samewhere.ellipseAxes = function (m, axes) {
    const kChi = Math.sqrt(7.815); // 95 % of chi-square with 3 degrees of freedom
    const { values, vectors } = samewhere.eigen([[m[0], m[1], m[2]], [m[1], m[3], m[4]], [m[2], m[4], m[5]]]);
    const half = values.map((value, i) => axes.direction(vectors.map((row) => row[i])).map((v) => v * kChi * Math.sqrt(Math.max(0, value))));
    return [[half[0], half[1]], [half[1], half[2]], [half[0], half[2]]];
  };
  // Of a symmetric 3 x 3 matrix, by Jacobi rotations; vectors are the columns.
  samewhere.eigen = function (matrix) {
    const a = matrix.map((row) => [...row]);
    const v = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    for (let sweep = 0; sweep < 20; ++sweep) {
      for (const [p, q] of [[0, 1], [0, 2], [1, 2]]) {
        if (Math.abs(a[p][q]) < 1e-300) continue;
        const theta = 0.5 * Math.atan2(2 * a[p][q], a[q][q] - a[p][p]);
        const c = Math.cos(theta);
        const s = Math.sin(theta);
        for (let k = 0; k < 3; ++k) [a[k][p], a[k][q]] = [c * a[k][p] - s * a[k][q], s * a[k][p] + c * a[k][q]];
        for (let k = 0; k < 3; ++k) [a[p][k], a[q][k]] = [c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]];
        for (let k = 0; k < 3; ++k) [v[k][p], v[k][q]] = [c * v[k][p] - s * v[k][q], s * v[k][p] + c * v[k][q]];
      }
    }
    return { values: [a[0][0], a[1][1], a[2][2]], vectors: v };
  };

  samewhere.drawing = { sprite, wideLines, continuedRows, segments, thinLines };
})();
