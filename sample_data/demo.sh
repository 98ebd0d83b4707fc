#!/bin/sh
# Build a TIN of each sample: GeoJSON for a GIS, PLY for mesh tools, a page to turn in a browser, PNG
# to look at; and ask the site for contours, a profile and the volumes of a design.
# Usage: sh sample_data/demo.sh FOLDER, with tinsmith on the PATH.
set -eu
samples=$(dirname "$0")
folder=${1:-demo}
mkdir -p "$folder"

# Drawn beside the commands that follow. A machine without OpenGL still gets the files; view says what
# it lacks.
draw() {
  tinsmith view "$folder/$1.ply" -o "$folder/$1.html" --title "$2" --quiet &
  page=$!
  tinsmith view "$folder/$1.ply" -o "$folder/$1.png" --title "$2" --quiet ||
    echo "Without a picture: $1.png"
  wait "$page"
}

echo "A survey of an invented site:"
tinsmith build "$samples/site_survey.csv" --crs EPSG:32616 --codes \
  -o "$folder/site_survey.geojson" -o "$folder/site_survey.ply"
draw site_survey "Site survey" &
site=$!

echo
echo "Contours, a profile and volumes of a building pad designed into it:"
tinsmith build "$samples/design_pad.csv" --crs EPSG:32616 --codes --quiet -o "$folder/design_pad.ply"
tinsmith contours "$folder/site_survey.ply" --interval 0.5 --smooth 0.1 \
  -o "$folder/contours.geojson" -o "$folder/contours.png"
tinsmith plan "$samples/site_survey.csv" --crs EPSG:32616 --codes --max-edge 20 --interval 0.5 \
  --scale 1000 --paper A3 --title "Site survey" -o "$folder/plan.pdf"
tinsmith profile "$folder/site_survey.ply" "$folder/design_pad.ply" \
  --from 752770 4024225 --to 752835 4024340 -o "$folder/profile.csv" -o "$folder/profile.png"
tinsmith volume "$folder/site_survey.ply" "$folder/design_pad.ply" \
  -o "$folder/volume.csv" -o "$folder/volume.png"

echo
echo "The hills around Jacksboro, Tennessee:"
tinsmith build "$samples/jacksboro.tif" \
  -o "$folder/jacksboro.geojson" -o "$folder/jacksboro.ply"
draw jacksboro "Jacksboro, Tennessee"
wait "$site"

echo
echo "Ready:"
ls -1 "$(cd "$folder" && pwd)"/*
