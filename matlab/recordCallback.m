% RECORDCALLBACK  Saves each new picture while a demonstration is going on.

if sensor.demoCue && any(strcmp('rgbVision', fieldnames(sensor)))
    recorded = recorded + 1;
    imwrite(sensor.rgbVision, sprintf('%s%05d.png', recordFolder, recorded));
    if recorded == 1, disp(['pictures go to ' recordFolder]); end
end
