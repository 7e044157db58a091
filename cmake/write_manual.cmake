# Writes manual pages from the program's help texts: slabhull.1, and one for each command.
#   cmake -DPROGRAM=FILE -DFOLDER=FOLDER -DVERSION=1.2.3 -DDOCUMENTS=FOLDER -P write_manual.cmake
function(write_page name summary)
    execute_process(COMMAND ${PROGRAM} ${ARGN} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
    string(REPLACE "${PROGRAM}" "slabhull" help "${help}")
    string(REPLACE "docs/" "${DOCUMENTS}/" help "${help}")
    string(REPLACE "\\" "\\e" help "${help}")
    string(REPLACE "-" "\\-" help "${help}")
    string(REGEX REPLACE "\n([.'])" "\n\\\\&\\1" help "${help}")
    string(TOUPPER ${name} title)
    file(WRITE ${FOLDER}/${name}.1 ".TH ${title} 1 \"\" \"Slabhull ${VERSION}\" \"User Commands\"\n.SH NAME\n"
        "${name} \\- ${summary}\n.SH DESCRIPTION\n.nf\n${help}\n.fi\n.SH EXIT STATUS\n"
        "0 done; 1 defects were found (check); 2 wrong usage or case file; 3 input that cannot be read or is no sound domain;\n"
        "4 the geometry or the meshing failed; 5 writing failed, or the format cannot hold the mesh;\n"
        "130 and 143 stopped by a signal, nothing half\\-written is left.\n")
endfunction()

file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
write_page(slabhull "space\\-time hulls of moving domains")
execute_process(COMMAND ${PROGRAM} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE ".*Subcommands:\n" "" help "${help}")
string(REPLACE ";" "," help "${help}") # which would part a list
string(REGEX MATCHALL "\n? +([a-z]+) +([^\n]+)" commands "\n${help}")
foreach(command IN LISTS commands)
    string(REGEX MATCH "([a-z]+) +([^\n]+)" command "${command}")
    write_page(slabhull-${CMAKE_MATCH_1} "${CMAKE_MATCH_2}" ${CMAKE_MATCH_1})
endforeach()
file(GLOB pages ${FOLDER}/*.1)
execute_process(COMMAND gzip -9n ${pages} COMMAND_ERROR_IS_FATAL ANY)
