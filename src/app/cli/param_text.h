// Parameters for people and for programs, from their one declaration.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "core/params.h"

namespace nephroid::cli {

/// One line per parameter, indented: name, sentence, default, range, unit. "" for none.
std::string formatParams(std::span<const ParamSpec> specs);

/// "NAME - TEXT (SOURCE)", wrapped: what stands above the parameters of a scene or technique.
std::string formatHeading(const std::string& name, const std::string& text, const std::string& source);

nlohmann::ordered_json paramsToJson(std::span<const ParamSpec> specs);

}  // namespace nephroid::cli
