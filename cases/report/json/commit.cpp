#include "cases/report/json/commit.h"

#include "built_from.h"

namespace rigor::inline report {

std::string commit() { return RIGOR_COMMIT; }

}  // namespace rigor::inline report
