// Writing a rendered picture: EXR as it is, PNG as people see it.
#pragma once

#include <string>
#include <vector>

#include "app/cli/options.h"
#include "core/image/image.h"

namespace nephroid::cli {

struct PictureOptions {
  std::string exposure = "auto";
  std::string tone_map = "none";
  bool half = false;
};

void addPictureOptions(CLI::App& app, PictureOptions& options);

/// The file that each layer goes to: with .exr all to `output`; with .png `beauty`, or else the first of `layers`, to
/// `output` and the others to NAME.LAYER.png beside it. One entry per layer.
/// @throws UsageError for any other kind of file
std::vector<std::string> pictureFiles(const std::string& output, const std::vector<std::string>& layers);

/// Checks the options and that every file can be written, before the work begins.
/// @throws UsageError, ResourceError
void checkPicture(const std::string& output, const std::vector<std::string>& layers, const PictureOptions& options);

/// @return the names of the files written
/// @throws ResourceError
std::vector<std::string> writePicture(const std::string& output, const LayeredImage& image,
                                      const PictureOptions& options);

}  // namespace nephroid::cli
