// It lies with the simulated runtime, whose folder builds alone.
#pragma once

#include "xr/simulated/script/toml_guard.h"
