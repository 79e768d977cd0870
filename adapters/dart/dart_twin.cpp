#include "adapters/dart/dart_twin.h"

#include "adapters/reduced_twin.h"

namespace rigor {

// DART's springs and dampers of joints are implicit, which this is not.
const Integrator kDartTwin = {
    .name = "dart-twin",
    .summary = "repeats DART's own smooth step, to explain its error",
    .order = 1,
    .symplectic = false,  // the gyroscopic term is explicit
    .leapfrog_stagger = 0.5,
    .default_orientation = "",
    .takes_contact = false,
    .takes_joints = true,
    .lacks = {"joint:distance", "joint-damper", "joint-limit", "joint-loop", "joint-spring", "motor:speed"},
    .twin_of = "dart",
    .make = [](const StepperParts& parts) { return make_reduced_twin(parts, exact_turn); },
};

}  // namespace rigor
