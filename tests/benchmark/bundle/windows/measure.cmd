@echo off
rem Measures errors and times of the techniques on this machine's device, and writes results\results.json, one file to send,
rem and results\report\index.html, a page with plots. On two CPU cores it takes 8 minutes, and as long again at the first run.
rem Before it, other values can be set: set SCENES=sphere,leaf  set SIZE=256x256  set OUT=C:\folder
setlocal
set "HERE=%~dp0"
if not defined OUT set "OUT=%HERE%results"
if not defined SCENES set "SCENES=sphere,three_lights,torus_knot,clutter,open_sheets,kitbash,fence,leaf,courtyard,package_duck"
if not defined SIZE set "SIZE=512x512"
if not defined GNOMON_CACHE_DIR set "GNOMON_CACHE_DIR=%HERE%references"
if not exist "%OUT%" mkdir "%OUT%"
"%HERE%gnomon.exe" info --json >"%OUT%\info.json"
if errorlevel 1 exit /b 1
"%HERE%gnomon.exe" report "%HERE%project" --scenes %SCENES% --sizes own --settings default --size %SIZE% --scaling none --change none --stability none --precision 0 --out "%OUT%\report"
if errorlevel 1 exit /b 1
echo { "format": "gnomon_bundle", "version": 1, "info": >"%OUT%\results.json"
type "%OUT%\info.json" >>"%OUT%\results.json"
echo , "report": >>"%OUT%\results.json"
type "%OUT%\report\report.json" >>"%OUT%\results.json"
echo , "times": [] } >>"%OUT%\results.json"
del "%OUT%\info.json"
echo Results: %OUT%\results.json
