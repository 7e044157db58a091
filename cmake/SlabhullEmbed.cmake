# slabhull_embed(<target> <name> <file>...): puts the text of the files, one after the other, into the program, as
# slabhull::embedded::<name>. So it is there wherever the program is installed.
function(slabhull_embed target name)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/text_of_${name}.cpp)
    set(script ${PROJECT_SOURCE_DIR}/cmake/SlabhullEmbedText.cmake)
    list(JOIN ARGN "," files)
    add_custom_command(OUTPUT ${source}
        COMMAND ${CMAKE_COMMAND} -DOUT=${source} -DNAME=${name} -DFILES=${files} -P ${script}
        DEPENDS ${ARGN} ${script} VERBATIM)
    set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    target_sources(${target} PRIVATE ${source})
endfunction()
