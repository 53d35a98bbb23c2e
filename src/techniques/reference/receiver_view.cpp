#include "techniques/reference/receiver_view.h"

#include "core/parallel.h"

namespace nephroid {

ReceiverView::ReceiverView(const ReferenceWorld& world)
    : width_(world.camera_model.width()),
      height_(world.camera_model.height()),
      seen_(static_cast<std::size_t>(width_) * height_) {
  constexpr int kPacket = static_cast<int>(TraceScene::kPacketSize);
  parallelFor(static_cast<std::size_t>(height_), [&](std::size_t row) {
    Ray rays[kPacket];
    const Ray* pointers[kPacket];
    RayHit hits[kPacket];
    for (int x = 0; x < width_; x += kPacket) {
      const int count = std::min(kPacket, width_ - x);
      for (int i = 0; i < count; ++i) {
        rays[i] = world.camera_model.rayThrough(vec2(x + i, row) + 0.5F);
        pointers[i] = &rays[i];
      }
      world.scene.intersectPacket({pointers, static_cast<std::size_t>(count)}, hits);
      for (int i = 0; i < count; ++i)
        seen_[row * static_cast<std::size_t>(width_) + x + i] = {rays[i].origin + hits[i].t * rays[i].dir,
                                                                 hits[i].instance};
    }
  });
}

}  // namespace nephroid
