#include "trace/box_grid.h"

namespace nephroid {

BoxGrid::BoxGrid(float cell, std::size_t boxes)
    : inverse_cell_(1.0F / cell), mask_(std::bit_ceil(static_cast<std::uint32_t>(boxes)) - 1) {}

void BoxGrid::Box::enter(glm::ivec3 cell) {
  const std::uint32_t bucket = grid_.bucketOf(cell);
  Entry entry{bucket, id_, stepsIn(cell, low_), stepsIn(cell, high_)};
  for (std::size_t i = first_; i < entries_.size(); ++i) {
    if (entries_[i].bucket != bucket) continue;
    // Two cells may share a bucket: it holds the box of both.
    for (std::size_t k = 0; k < 3; ++k) {
      entries_[i].low[k] = std::min(entries_[i].low[k], entry.low[k]);
      entries_[i].high[k] = std::max(entries_[i].high[k], entry.high[k]);
    }
    return;
  }
  entries_.push_back(entry);
}

void BoxGrid::close(std::span<const std::vector<Entry>> chunks) {
  begin_.assign(std::size_t{mask_} + 2, 0);
  for (const std::vector<Entry>& chunk : chunks)
    for (const Entry& e : chunk) ++begin_[e.bucket + 1];
  for (std::size_t b = 0; b <= mask_; ++b) begin_[b + 1] += begin_[b];
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  ids_.resize(begin_.back());
  sides_.assign(kSides * ids_.size() + kLanes, 0);
  for (const std::vector<Entry>& chunk : chunks)
    for (const Entry& e : chunk) {
      const std::size_t begin = begin_[e.bucket], count = begin_[e.bucket + 1] - begin, at = next[e.bucket]++;
      ids_[at] = e.id;
      std::uint8_t* side = sides_.data() + kSides * begin + (at - begin);
      for (std::size_t k = 0; k < 3; ++k) side[k * count] = e.low[k], side[(3 + k) * count] = e.high[k];
    }
}

}  // namespace nephroid
