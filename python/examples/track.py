"""Tracks a recording and prints each pose as it comes: python3 track.py RECORDING [SECTION.KEY=VALUE ...]"""
import sys

import samewhere

recording = samewhere.Recording(sys.argv[1], settings=sys.argv[2:])
slam = samewhere.Slam(recording.calibration())
for frame in recording:
    tracked = slam.track(frame)
    if tracked.has_pose:
        print(f"{tracked.stamp_s:.6f}", *tracked.map_from_camera[:3, 3].round(4), flush=True)
    for event in slam.take_events():
        if isinstance(event.what, samewhere.LoopVerdict) and event.what.decision == samewhere.LoopDecision.ACCEPTED:
            print("loop closed:", event.what.reason)
slam.finish()
samewhere.evaluate.write_trajectory("trajectory.tum", slam.trajectory())
