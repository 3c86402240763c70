# Read by find_package(pneuma): what the libraries link, then the libraries.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4)
find_dependency(Threads)
find_dependency(fmt)
include(${CMAKE_CURRENT_LIST_DIR}/pneuma-targets.cmake)
