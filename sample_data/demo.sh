#!/bin/sh
# Build a TIN of each sample: GeoJSON for a GIS, PLY for mesh tools, PNG to look at.
# Usage: sh sample_data/demo.sh FOLDER, with tinsmith on the PATH.
set -eu
samples=$(dirname "$0")
folder=${1:-demo}
mkdir -p "$folder"

echo "A survey of an invented site:"
tinsmith build "$samples/site_survey.csv" --crs EPSG:32616 \
  -o "$folder/site_survey.geojson" -o "$folder/site_survey.ply"
tinsmith view "$folder/site_survey.ply" -o "$folder/site_survey.png" --title "Site survey" --quiet

echo
echo "The hills around Jacksboro, Tennessee:"
tinsmith build "$samples/jacksboro.tif" \
  -o "$folder/jacksboro.geojson" -o "$folder/jacksboro.ply"
tinsmith view "$folder/jacksboro.ply" -o "$folder/jacksboro.png" \
  --title "Jacksboro, Tennessee" --quiet

echo
echo "Ready in $(cd "$folder" && pwd):"
for file in site_survey jacksboro; do
  for suffix in geojson ply png; do echo "  $file.$suffix"; done
done
