#include <dlfcn.h>
#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file_kind.hpp>
#include <samewhere/core/own_file.hpp>
#include <samewhere/input/video_plugin.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

// A function of the plugin, which is never unloaded: FFmpeg leaves things behind that run at exit.
template <class Function>
Function* load(const path& plugin, const char* symbol) {
  void* const library = dlopen(plugin.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const function = library == nullptr ? nullptr : dlsym(library, symbol);
  if (function != nullptr) return reinterpret_cast<Function*>(function);
  const char* const reason = dlerror();
  throw InputError(fmt::format(
      "{}: the plugin that reads videos, cameras, BMP, PNM, TIFF and WebP cannot be loaded ({}); "
      "`./run build` makes it",
      plugin.string(), reason == nullptr ? "no reason given" : reason));
}

}  // namespace

path video_plugin_path() {
  const char* const name = "samewhere-video.so";
  const path folder = core::own_file().parent_path();
  if (folder.empty()) return name;
  // where it is built; of libsamewhere.so in the library folder; of a program in bin/
  for (const path& place :
       {folder, folder / "samewhere", folder / ".." / SAMEWHERE_PLUGIN_FOLDER}) {
    std::error_code error;
    const path plugin = std::filesystem::weakly_canonical(place / name, error);
    if (!error && std::filesystem::exists(plugin, error)) return plugin;
  }
  return folder / name;
}

std::unique_ptr<VideoDecoder> open_decoder(const path& video, bool is_camera, const path& plugin) {
  if (!is_camera) core::require_file(video);  // a pipe would be waited for without end
  auto* const open = load<OpenVideo>(plugin, kOpenVideoSymbol);
  std::unique_ptr<VideoDecoder> decoder(open(video.c_str(), is_camera));
  if (decoder != nullptr) return decoder;
  throw InputError(video.string() +
                   (is_camera
                        ? ": cannot be opened as a camera; is it one, and does no other program "
                          "use it?"
                        : ": cannot be read as a video; an MP4 or MOV whose recording was cut off "
                          "before it was closed has no index and cannot be read either"));
}

bool decode_by_plugin(const unsigned char* bytes, std::size_t num_bytes, cv::Mat& image) {
  static auto* const decode = load<DecodePicture>(video_plugin_path(), kDecodePictureSymbol);
  return decode(bytes, num_bytes, image);
}

}  // namespace samewhere::input
