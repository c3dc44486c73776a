#include "high/above.h"
#include "low/below.h"
