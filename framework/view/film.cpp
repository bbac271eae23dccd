#include "framework/view/film.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/files/temporary_folder.hpp"
#include "framework/base/text/escape.hpp"
#include "framework/base/worker/run_program.hpp"
#include "framework/view/drawing.hpp"

namespace twinmap::view {
namespace {

namespace fs = std::filesystem;

constexpr int kRate = 25;  // frames a second

/// Of motions after the first only what moves is drawn, in the colours of the page's machines.
constexpr const char* kFilmStyle = R"(<style>
.paper { fill: #fff; }
.motion1 text, .motion1 .axis, .motion1 circle, .motion2 text, .motion2 .axis, .motion2 circle { display: none; }
.mechanism .motion1 .body { fill: #54a24b; stroke: #54a24b; }
.mechanism .motion1 .link { stroke: #54a24b; }
.mechanism .motion2 .body { fill: #f58518; stroke: #f58518; }
.mechanism .motion2 .link { stroke: #f58518; }
.mechanism .key0 { fill: #4c78a8; } .mechanism .key1 { fill: #54a24b; } .mechanism .key2 { fill: #f58518; }
</style>
)";

/// Points of a mesh that lie outermost in one of many directions: its outline, to 0.3 % of its size.
void keepOutermost(SceneShape& shape) {
  constexpr int kDirections = 500;  // 9 degrees apart, on a spiral about the sphere
  std::set<std::size_t> kept;
  const auto& points = shape.mesh.points;
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kDirections, angle = 2.399963229728653 * i;  // the golden one
    const double r = std::sqrt(1.0 - z * z);
    const Vector along{r * std::cos(angle) * shape.size.x, r * std::sin(angle) * shape.size.y,
                       z * shape.size.z};
    const auto farther = [&](const auto& one, const auto& other) {
      const auto reach = [&](const auto& p) { return along.x * p[0] + along.y * p[1] + along.z * p[2]; };
      return reach(one) < reach(other);
    };
    kept.insert(std::max_element(points.begin(), points.end(), farther) - points.begin());
  }
  Mesh mesh;
  for (const std::size_t place : kept) {
    mesh.points.push_back(points[place]);
  }
  shape.mesh = mesh;
}

/// The same scene, whose meshes cost little to outline.
Scene lighten(Scene scene) {
  for (SceneBody& body : scene.bodies) {
    for (SceneShape& shape : body.shapes) {
      if (shape.kind == "mesh") {
        keepOutermost(shape);
      }
    }
  }
  return scene;
}

Camera fitAll(const Scene& scene) {
  std::vector<const Poses*> shown;
  for (const SceneMotion& motion : scene.motions) {
    for (const Poses& poses : motion.poses) {
      shown.push_back(&poses);
    }
  }
  return fitCamera(scene, shown);
}

std::string drawFrame(const Scene& scene, const Camera& camera, std::size_t frame, double speed) {
  constexpr double kPixels = 1.5;  // of the film, a pixel of the picture
  std::string text = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" class="mechanism" viewBox="0 0 {0:.0f} {1:.0f}" width="{2:.0f}" height="{3:.0f}">)",
      kPictureWidth, kPictureHeight, kPixels * kPictureWidth, kPixels * kPictureHeight);
  text += std::string(kPictureStyle) + kFilmStyle + R"(<rect class="paper" width="100%" height="100%"/>)";
  for (std::size_t i = scene.motions.size(); i-- > 0;) {
    text += fmt::format("<g class=\"motion{}\">", i) +
            drawMechanism(scene, camera, scene.motions[i].poses[frame]) + "</g>\n";
  }
  for (std::size_t i = 0; i < scene.motions.size(); ++i) {
    text += fmt::format(R"(<text class="key{}" x="10" y="{}">{}</text>)", i, 20 + 16 * i,
                        escapeHtml(scene.motions[i].name));
  }
  return text + fmt::format(R"(<text x="10" y="{:.0f}">{:.3f} s{}</text></svg>)", kPictureHeight - 10.0,
                            scene.times[static_cast<Eigen::Index>(frame)],
                            speed == 1.0 ? "" : fmt::format(", at {:g} times the speed", speed));
}

void encode(const fs::path& folder, const fs::path& film) {
  const fs::path log = folder / "ffmpeg.log";
  const int status =
      runProgram({"ffmpeg", "-nostdin", "-y", "-loglevel", "error", "-framerate", std::to_string(kRate), "-i",
                  "frame%05d.svg", "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4",
                  "file:" + fs::absolute(film).string()},
                 folder, log);
  if (status != 0) {
    constexpr std::size_t kMost = 500;  // characters: the first errors
    throw std::runtime_error("ffmpeg does not make a film; it needs librsvg and H.264, as Debian's has: " +
                             readBytes(log).substr(0, kMost));
  }
}

}  // namespace

FilmPace choosePace(double duration) {
  constexpr double kShortest = 2.0, kLongest = 60.0;  // s: enough to see it; as long as one looks
  double speed = 1.0;
  if (!(duration > 0.0)) {
    return {1, speed};
  }
  for (int exponent = 0; duration / speed < kShortest || duration / speed > kLongest;) {
    exponent += duration / speed < kShortest ? -1 : 1;
    const int step = ((exponent % 3) + 3) % 3;
    speed = (step == 0 ? 1.0 : step == 1 ? 2.0 : 5.0) * std::pow(10.0, (exponent - step) / 3);
  }
  return {1 + static_cast<int>(std::lround(duration / speed * kRate)), speed};
}

void requireFilmWriter() {
  const TemporaryFolder folder;
  if (runProgram({"ffmpeg", "-version"}, folder.getPath(), folder.getPath() / "log") != 0) {
    throw std::runtime_error(
        "a film is made by ffmpeg, which is not here: install it (apt install ffmpeg), or leave --mp4 out");
  }
}

void writeFilm(const Scene& scene, double speed, const std::string& path) {
  if (scene.bodies.empty() || scene.times.size() < 2) {
    throw std::runtime_error(path + ": a film is of a mechanism that moves, and " + scene.name +
                             (scene.bodies.empty() ? " has outputs alone" : " stands still") +
                             ": leave --mp4 out");
  }
  const Scene light = lighten(scene);
  const Camera camera = fitAll(light);
  const TemporaryFolder folder;
  for (std::size_t frame = 0; frame < light.motions.front().poses.size(); ++frame) {
    std::ofstream file(folder.getPath() / fmt::format("frame{:05}.svg", frame));
    file << drawFrame(light, camera, frame, speed);
    if (!file.flush()) {
      throw std::runtime_error(path + ": no room for its frames in " + folder.getPath().string());
    }
  }
  writeAtomically(path, [&](const fs::path& film) { encode(folder.getPath(), film); });
}

}  // namespace twinmap::view
