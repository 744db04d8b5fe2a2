# Writes OUTPUT from TEMPLATE with the texts of STYLE_SHEET_FILE and SCRIPT_FILE in place.
file(READ ${STYLE_SHEET_FILE} STYLE_SHEET)
file(READ ${SCRIPT_FILE} SCRIPT)
configure_file(${TEMPLATE} ${OUTPUT} @ONLY)
