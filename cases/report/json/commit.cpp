#include "cases/report/json/commit.h"

#include "built_from.h"

namespace rigor {

std::string commit() { return RIGOR_COMMIT; }

}  // namespace rigor
