// Both images of a candidate with the matches between them.
(function () {
  const loaded = new Map();
  function load(source) {
    if (!loaded.has(source)) {
      loaded.set(source, new Promise((resolve) => {
        const image = new Image();
        image.onload = () => resolve(image);
        image.onerror = () => resolve(null);
        image.src = source;
      }));
    }
    return loaded.get(source);
  }

  const kMaxLines = { inliers: 45, outliers: 15 }; // more would hide the images

  // Marks at the matched features, and lines between those of an even share of them.
  function drawMatches(pen, matches, boxes, shown) {
    const at = (box, x, y) => [box.x + (x / 65535) * box.width, box.y + (y / 65535) * box.height];
    const draw = (name, isInlier, colour) => {
      const rows = Array.from(matches.areInliers.keys()).filter((row) => Boolean(matches.areInliers[row]) === isInlier);
      const step = Math.ceil(rows.length / kMaxLines[name]);
      pen.strokeStyle = colour;
      rows.forEach((row, i) => {
        const s = matches.shares.subarray(4 * row, 4 * row + 4);
        const ends = [at(boxes[0], s[0], s[1]), at(boxes[1], s[2], s[3])];
        if (i % step === 0) drawLine(pen, ends, isInlier, shown.scale || 1);
        ends.forEach(([x, y]) => drawMark(pen, x, y, isInlier, shown.scale || 1));
      });
    };
    if (shown.outliers) draw('outliers', false, samewhere.css('outlier-match'));
    if (shown.inliers) draw('inliers', true, samewhere.css('inlier-match'));
  }
  function drawLine(pen, ends, isInlier, scale) {
    pen.globalAlpha = isInlier ? 0.65 : 0.45;
    pen.lineWidth = 0.9 * scale;
    pen.setLineDash(isInlier ? [] : [3, 3]);
    pen.beginPath();
    pen.moveTo(...ends[0]);
    pen.lineTo(...ends[1]);
    pen.stroke();
    pen.setLineDash([]);
    pen.globalAlpha = 1;
  }
  function drawMark(pen, x, y, isInlier, scale) {
    const size = 2.1 * scale;
    pen.lineWidth = 1.1 * scale;
    pen.globalAlpha = isInlier ? 0.9 : 0.7;
    pen.beginPath();
    if (isInlier) pen.arc(x, y, size, 0, 7);
    else { pen.moveTo(x - size, y - size); pen.lineTo(x + size, y + size); pen.moveTo(x - size, y + size); pen.lineTo(x + size, y - size); }
    pen.stroke();
    pen.globalAlpha = 1;
  }

  // Draws the pair over the width of the canvas; resolves when it is drawn.
  samewhere.drawPair = async function (canvas, candidate, shown) {
    const images = await Promise.all([candidate.queryPicture, candidate.matchPicture].map((source) => (source ? load(source) : null)));
    const width = canvas.clientWidth || 400;
    const ratio = Math.min(2, devicePixelRatio || 1);
    const gap = 4;
    const each = (width - gap) / 2;
    const height = Math.max(...images.map((image) => (image ? (each * image.height) / image.width : each * 0.75)));
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    canvas.style.height = `${height}px`;
    const pen = canvas.getContext('2d');
    pen.scale(ratio, ratio);
    const boxes = images.map((image, i) => ({ x: i * (each + gap), y: 0, width: each, height: image ? (each * image.height) / image.width : height }));
    images.forEach((image, i) => {
      const box = boxes[i];
      if (image) pen.drawImage(image, box.x, box.y, box.width, box.height);
      else {
        pen.fillStyle = samewhere.css('line');
        pen.fillRect(box.x, box.y, box.width, box.height);
        pen.fillStyle = samewhere.css('soft');
        pen.font = '12px sans-serif';
        pen.fillText('picture not kept', box.x + 10, box.y + 22);
      }
    });
    const matches = samewhere.matchesOf(candidate);
    if (matches) drawMatches(pen, matches, boxes, shown);
    canvas.dataset.drawn = candidate.id;
  };
})();
