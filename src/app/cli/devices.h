// How a list of devices is printed.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

#include "gpu/device_survey.h"

namespace nephroid::cli {

/// A block for each device, then a line for `auto`; one line where there is no device.
std::string formatDevices(const gpu::DeviceSurvey& survey);

/// {"devices": […], "auto": number or null, "reason": "…"}.
nlohmann::ordered_json devicesToJson(const gpu::DeviceSurvey& survey);

}  // namespace nephroid::cli
