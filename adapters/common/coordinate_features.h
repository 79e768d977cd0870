// What every engine with joints expresses on the coordinate of hinges and sliders.
#pragma once

#include "core/scene/features/feature.h"

namespace rigor::inline adapters {

inline const Features kCoordinateFeatures = {
    Feature::joint_spring, Feature::quadratic_spring, Feature::joint_damper, Feature::joints_with_dampers,
    Feature::motor_effort, Feature::motor_servo,      Feature::motor_table};

}  // namespace rigor::inline adapters
