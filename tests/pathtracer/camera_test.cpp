#include "pathtracer/camera.hpp"

#include <doctest/doctest.h>
