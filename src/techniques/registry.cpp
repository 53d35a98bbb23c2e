#include <fmt/format.h>

#include "nephroid/error.h"
#include "techniques/reference/reference.h"
#include "techniques/technique.h"

namespace nephroid {

std::span<const Technique> techniques() {
  // One line a technique: an explicit list, because static registration is dropped by linkers of static libraries.
  static const Technique list[] = {
      makeReferenceTechnique(),
  };
  return list;
}

const Technique& findTechnique(std::string_view name) {
  std::vector<std::string> names;
  for (const Technique& technique : techniques()) {
    if (technique.name == name) return technique;
    names.push_back(technique.name);
  }
  throw UsageError(fmt::format("no technique '{}'; there are: {}", name, fmt::join(names, ", ")));
}

}  // namespace nephroid
