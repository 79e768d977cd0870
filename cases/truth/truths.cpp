#include "cases/truth/truth.h"
