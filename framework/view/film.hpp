#pragma once

#include <string>

#include "framework/view/scene.hpp"

namespace twinmap::view {

/// How fast a film shows a motion.
struct FilmPace {
  int frames;    ///< at equal steps of the motion's time, both ends included
  double speed;  ///< model's seconds a second
};

/// In real time where that takes 2 to 60 s; else slower or faster by 1, 2 or 5 times a power of 10.
FilmPace choosePace(double duration);

/// Throws std::runtime_error, which says what to install, where there is no ffmpeg.
void requireFilmWriter();

/// Writes an MP4 (ffmpeg) in which all motions of the scene are overlaid in the page's colours, seen as the
/// static picture is. Throws std::runtime_error where the scene has no bodies or stands still, or ffmpeg
/// fails. Cost: some 30 ms a frame.
void writeFilm(const Scene& scene, double speed, const std::string& path);

}  // namespace twinmap::view
