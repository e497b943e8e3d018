// Terms of the field as tooltips.
(function () {
  const terms = {
    'loop closure': 'A relative pose between two views of one place, taken at different times. It corrects the accumulated drift.',
    'loop candidate': 'Two views that place recognition found similar. The loop verifier accepts it, rejects it or leaves it ambiguous.',
    'false loop closure': 'An accepted loop closure between two different places. One is enough to fold the map.',
    'perceptual aliasing': 'Different places look alike, for instance two corridors of one building.',
    accepted: 'All checks passed: the candidate is a loop closure.',
    false: 'Accepted, and the ground truth contradicts it: the relative pose is wrong by more than 0.2 m or 6 degrees.',
    rejected: 'A check failed. The candidate is not in the pose graph.',
    ambiguous: 'Neither accepted nor rejected: what is known would also hold of another place.',
    withdrawn: 'Accepted first, and taken out of the pose graph later, when it contradicted more likely loop closures.',
    similarity: 'Similarity of the image descriptors of the two views, from -1 to 1. First check.',
    pause: 'Time since the last accepted loop. Off, except in the published method.',
    matches: 'Features of the two images with similar descriptors.',
    inliers: 'Matches that agree on one relative pose of the two views.',
    'inlier ratio': 'Inliers as a share of the matches.',
    spread: 'Share of the 8 x 8 cells of the image that hold an inlier.',
    overlap: 'Share of either image that is visible in the other.',
    pose: 'Whether the inliers give a relative pose. Without depth or calibration they do not.',
    consistency: 'The relative pose is estimated twice, from the depth of each view. Both must agree.',
    'odometry gate': 'The correction that the candidate asks for must be within the accumulated drift of odometry.',
    'chi-square': 'Squared Mahalanobis distance: the squared correction, weighted by the inverse of its covariance. 6 degrees of freedom.',
    competing: 'Competing hypothesis: another place, or the loop closures so far, explain the query as well or better.',
    sequence: 'Neighbouring views must match, too. In recognition without a map alone.',
    evidence: 'Where places may look alike, odometry must tell this place from a look-alike place.',
    'look-alike gain': 'Log-likelihood ratio, times two, of this place over the nearest look-alike place, under odometry.',
    graph: 'The robust pose graph must keep the loop closure beside odometry and the earlier ones.',
    deformation: 'How much the trajectory bends when the candidate is added to the pose graph.',
    keyframe: 'A frame that is kept in the map, with its features.',
    landmark: 'A point of the map, triangulated from features or measured by a depth camera.',
    odometry: 'Motion from frame to frame, without loop closures. Its error accumulates: drift.',
    drift: 'Accumulated error of odometry.',
    correction: 'Distance between the final position of a frame and its position by odometry alone.',
    'ATE RMSE': 'Absolute trajectory error: root mean square distance to the ground truth after rigid alignment.',
    NEES: 'Normalized estimation error squared: squared error, weighted by the inverse covariance. 6 if the covariance is consistent.',
    tracking: 'The pose of the frame was measured.',
    weak: 'The pose was measured with few inliers.',
    lost: 'The frame has no pose.',
    relocalized: 'Tracking was lost, and the frame has been located in the map.',
    provisional: 'Relocalized, not confirmed yet: the place may be a look-alike.',
    initializing: 'No map yet.',
    covariance: 'Uncertainty of a position. The ellipse holds it with 95 % probability.',
  };
  samewhere.terms = terms;

  // The text of a term with its explanation as a tooltip.
  samewhere.term = function (name, text = name) {
    if (!terms[name]) return document.createTextNode(text);
    return samewhere.element('span', { class: 'term', 'data-term': name, tabindex: 0 }, text);
  };
  const ofChecks = { odometry: 'odometry gate' };
  samewhere.checkTerm = (check) => samewhere.term(ofChecks[check] || check, check);

  samewhere.startTooltips = function () {
    const tip = samewhere.byId('tooltip');
    const show = (event) => {
      const target = event.target.closest ? event.target.closest('[data-term]') : null;
      if (!target) { tip.hidden = true; return; }
      tip.textContent = terms[target.dataset.term];
      tip.hidden = false;
      const box = target.getBoundingClientRect();
      tip.style.left = `${Math.max(8, Math.min(box.left, innerWidth - tip.offsetWidth - 8))}px`;
      const below = box.bottom + 6;
      tip.style.top = `${below + tip.offsetHeight < innerHeight ? below : box.top - tip.offsetHeight - 6}px`;
    };
    document.addEventListener('mouseover', show);
    document.addEventListener('focusin', show);
  };

  samewhere.showGlossary = function () {
    const list = samewhere.byId('glossary');
    for (const [name, text] of Object.entries(terms).sort((a, b) => a[0].localeCompare(b[0]))) {
      list.append(samewhere.element('dt', {}, name), samewhere.element('dd', {}, text));
    }
  };
})();
