while IFS=':,{}' read -r _ _ index _ _ _ speed _ gap _; do speed=${speed%.*}
  echo "{\"index\":$index,\"robustness\":{\"stops-in-time\":$((${gap%.*} - speed * 3 / 10 - speed * speed / 100))}}"; done
