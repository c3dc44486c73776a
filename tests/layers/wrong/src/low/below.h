#pragma once
#include "high/above.h"
