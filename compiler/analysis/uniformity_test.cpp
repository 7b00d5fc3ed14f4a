#include "analysis/uniformity.hpp"
#include <catch2/catch.hpp>
