// Trajectories as CSV: time,body and the thirteen columns of a body's state, 17 significant digits (so that reading
// gives the same double again), one row a body and instant. Names are quoted as RFC 4180 asks where they need it.
#pragma once

#include <string>

#include "core/engine/trajectory.h"
#include "core/scene/scene.h"

namespace rigor {

std::string csv_header();
std::string csv_field(const std::string& text);

// The rows of one instant. `last_column` is appended to each: "" or ",<number>".
void append_csv_rows(std::string& out, const Scene& scene, double time, BodyColumns bodies,
                     const std::string& last_column = "");

// Writes the whole of it to `path`. Throws std::runtime_error if that fails.
void write_trajectory(const std::string& path, const Scene& scene, const Trajectory& trajectory);

}  // namespace rigor
