// Types of the values in a glTF file, as one table: what may stand where.
#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

namespace nephroid::gltf {

/// Checks that every value that we read has its type and that every number fits into what it is read as (an index into
/// int, a quantity into float). Unknown properties pass. Ranges that mean something (roughness in [0, 1]) are not
/// looked at here, nor are `extras`, which belong to whoever wrote them. Whole numbers written as "2.0" become
/// integers.
/// @throws InputError "FILE: materials[3].alphaCutoff: found a string, expected a number"
void checkTypes(nlohmann::json& root, const std::filesystem::path& path);

}  // namespace nephroid::gltf
