#pragma once

// The queries of Embree 3 and 4 behind one name each: what a query is asked with differs between
// the two. Included by ray_scene.cpp alone; SAMEWHERE_EMBREE is the version that CMake found.
#if SAMEWHERE_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace samewhere::twin::embree {

#if SAMEWHERE_EMBREE >= 4

inline void intersect(RTCScene scene, RTCRayHit& asked) { rtcIntersect1(scene, &asked); }

// Eight rays that run alike; `valid` is -1 for those that are asked, 0 for the others.
inline void intersect(const int* valid, RTCScene scene, RTCRayHit8& asked) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect8(valid, scene, &asked, &arguments);
}

// Of a ray that is blocked tfar becomes negative.
inline void find_blocked(RTCScene scene, RTCRay& asked) { rtcOccluded1(scene, &asked); }

#else

inline RTCIntersectContext context_of(RTCIntersectContextFlags flags) {
  RTCIntersectContext context{};
  rtcInitIntersectContext(&context);
  context.flags = flags;
  return context;
}

inline void intersect(RTCScene scene, RTCRayHit& asked) {
  RTCIntersectContext context = context_of(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  rtcIntersect1(scene, &context, &asked);
}

// Eight rays that run alike; `valid` is -1 for those that are asked, 0 for the others.
inline void intersect(const int* valid, RTCScene scene, RTCRayHit8& asked) {
  RTCIntersectContext context = context_of(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  rtcIntersect8(valid, scene, &context, &asked);
}

// Of a ray that is blocked tfar becomes negative.
inline void find_blocked(RTCScene scene, RTCRay& asked) {
  RTCIntersectContext context = context_of(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  rtcOccluded1(scene, &context, &asked);
}

#endif

}  // namespace samewhere::twin::embree
