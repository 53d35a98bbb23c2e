// Embree 3 and 4 behind one thin header: owning handles, checked errors, two ways to trace rays.
//
// The only place that knows which version it is. Embree 4 drops the intersect context in favour of arguments that
// default to null, and renames the header folder; everything else that we use is the same.
#pragma once

#if NEPHROID_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <utility>

#include "core/parallel.h"

namespace nephroid {

/// Owns a reference to one Embree object; move-only.
template <class Handle, void (*kRelease)(Handle)>
class EmbreeHandle {
 public:
  EmbreeHandle() = default;
  explicit EmbreeHandle(Handle handle) : handle_(handle) {}
  EmbreeHandle(EmbreeHandle&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  EmbreeHandle& operator=(EmbreeHandle&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  EmbreeHandle(const EmbreeHandle&) = delete;
  EmbreeHandle& operator=(const EmbreeHandle&) = delete;
  ~EmbreeHandle() {
    if (handle_) kRelease(handle_);
  }
  Handle get() const { return handle_; }

 private:
  Handle handle_ = nullptr;
};

/// Wider vectors lower the clock of some processors by more than they gain.
#ifdef NEPHROID_SANITIZE_THREAD
// The sanitizer cannot look into Embree's own threads.
inline constexpr const char* kEmbreeConfig = "frequency_level=simd256,threads=1";
#else
inline constexpr const char* kEmbreeConfig = "frequency_level=simd256";
#endif

using EmbreeDevice = EmbreeHandle<RTCDevice, rtcReleaseDevice>;
using EmbreeScene = EmbreeHandle<RTCScene, rtcReleaseScene>;
using EmbreeGeometry = EmbreeHandle<RTCGeometry, rtcReleaseGeometry>;

/// What Embree 3 calls a context and Embree 4 the arguments of a query.
/// @param coherent  rays stay together nearly to the end: visits each node once for all of a packet
#if NEPHROID_EMBREE_MAJOR >= 4
inline RTCIntersectArguments makeIntersectQuery(bool coherent) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  return arguments;
}
inline RTCOccludedArguments makeOccludedQuery(bool coherent) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  return arguments;
}
#else
inline RTCIntersectContext makeQuery(bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}
#endif

/// Nearest hit of `ray_hit.ray`; `ray_hit.hit.geomID` is RTC_INVALID_GEOMETRY_ID if there is none.
inline void intersectClosest(RTCScene scene, RTCRayHit& ray_hit, bool coherent = false) {
#if NEPHROID_EMBREE_MAJOR >= 4
  RTCIntersectArguments arguments = makeIntersectQuery(coherent);
  rtcIntersect1(scene, &ray_hit, &arguments);
#else
  RTCIntersectContext context = makeQuery(coherent);
  rtcIntersect1(scene, &context, &ray_hit);
#endif
}

/// True if anything lies on the ray; `ray.tfar` is −infinity afterwards if so.
inline bool intersectAny(RTCScene scene, RTCRay& ray) {
#if NEPHROID_EMBREE_MAJOR >= 4
  RTCOccludedArguments arguments = makeOccludedQuery(false);
  rtcOccluded1(scene, &ray, &arguments);
#else
  RTCIntersectContext context = makeQuery(false);
  rtcOccluded1(scene, &context, &ray);
#endif
  return ray.tfar < 0.0F;
}

/// Eight rays at once, those whose `valid` is −1; they run alike, or packets gain nothing.
/// @param valid  [8], aligned to 32 bytes
inline void intersectClosest8(const int* valid, RTCScene scene, RTCRayHit8& ray_hits, bool coherent) {
#if NEPHROID_EMBREE_MAJOR >= 4
  RTCIntersectArguments arguments = makeIntersectQuery(coherent);
  rtcIntersect8(valid, scene, &ray_hits, &arguments);
#else
  RTCIntersectContext context = makeQuery(coherent);
  rtcIntersect8(valid, scene, &context, &ray_hits);
#endif
}

/// The same for intersectAny: `rays.tfar` is −infinity where something lies on the ray.
inline void intersectAny8(const int* valid, RTCScene scene, RTCRay8& rays, bool coherent) {
#if NEPHROID_EMBREE_MAJOR >= 4
  RTCOccludedArguments arguments = makeOccludedQuery(coherent);
  rtcOccluded8(valid, scene, &rays, &arguments);
#else
  RTCIntersectContext context = makeQuery(coherent);
  rtcOccluded8(valid, scene, &context, &rays);
#endif
}

}  // namespace nephroid
