# three.js as Debian packs it (libjs-three), text that goes into the pages of `slabhull view`: defines ThreeJS_SCRIPT
# and ThreeJS_CONTROLS.
set(ThreeJS_places javascript/three javascript/three/build)
find_file(ThreeJS_SCRIPT three.min.js PATHS /usr/share /usr/local/share PATH_SUFFIXES ${ThreeJS_places})
find_file(ThreeJS_CONTROLS OrbitControls.js PATHS /usr/share /usr/local/share
    PATH_SUFFIXES javascript/three/examples/js/controls)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ThreeJS REQUIRED_VARS ThreeJS_SCRIPT ThreeJS_CONTROLS)
