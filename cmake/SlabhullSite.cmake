# The target "site": the documentation site, an optional part. Sphinx with myst-parser, breathe and a theme, Doxygen, and the
# Python module, whose docstrings are on it. Warnings are errors, and links are checked.
set(SLABHULL_SITE AUTO CACHE STRING "The documentation site: ON, OFF, or AUTO if what makes it is installed")
set_property(CACHE SLABHULL_SITE PROPERTY STRINGS AUTO ON OFF)
option(SLABHULL_SITE_EXTERNAL_LINKS "The target site asks for addresses on the network, too" OFF)
if(NOT SLABHULL_SITE)
    return()
endif()

set(site_missing)
if(NOT TARGET docs)
    list(APPEND site_missing "Doxygen (doxygen)")
endif()
if(NOT SLABHULL_HAS_PYTHON_MODULE)
    list(APPEND site_missing "the Python module")
else()
    foreach(name IN ITEMS sphinx myst_parser breathe sphinx_rtd_theme)
        execute_process(COMMAND "${Python3_EXECUTABLE}" -c
            "import sys, importlib.util; sys.exit(importlib.util.find_spec('${name}') is None)"
            RESULT_VARIABLE absent OUTPUT_QUIET ERROR_QUIET)
        if(NOT absent EQUAL 0)
            list(APPEND site_missing "Python's ${name}")
        endif()
    endforeach()
endif()
if(site_missing)
    list(JOIN site_missing " and " site_missing)
    if(SLABHULL_SITE STREQUAL "AUTO")
        message(STATUS "The documentation site is left out: ${site_missing} not found")
        return()
    endif()
    message(FATAL_ERROR "SLABHULL_SITE: ${site_missing} not found")
endif()

set(site ${PROJECT_BINARY_DIR}/site)
set(site_source ${PROJECT_SOURCE_DIR}/docs/site)
configure_file(${site_source}/Doxyfile.in ${site}/Doxyfile @ONLY)
set(external)
if(SLABHULL_SITE_EXTERNAL_LINKS)
    set(external --external)
endif()
add_custom_target(site
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${site}/xml ${site}/html
    COMMAND ${DOXYGEN_EXECUTABLE} ${site}/Doxyfile
    COMMAND ${Python3_EXECUTABLE} ${site_source}/prepare.py ${PROJECT_SOURCE_DIR} ${site}/xml ${site}/pages ${doxygen_rooms}
    COMMAND ${CMAKE_COMMAND} -E env "PYTHONPATH=${PROJECT_BINARY_DIR}/python" PYTHONDONTWRITEBYTECODE=1
        "SLABHULL_XML=${site}/xml" "SLABHULL_VERSION=${PROJECT_VERSION}"
        ${Python3_EXECUTABLE} -m sphinx -q -W --keep-going -b html -d ${site}/doctrees -c ${site_source} ${site}/pages ${site}/html
    COMMAND ${CMAKE_COMMAND} -E copy ${site_source}/index.html ${site}/html/index.html
    COMMAND ${Python3_EXECUTABLE} ${site_source}/check_links.py ${site}/html ${external}
    COMMENT "The documentation site: ${site}/html/index.html" VERBATIM USES_TERMINAL)
add_dependencies(site slabhull_python)
